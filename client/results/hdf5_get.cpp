// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>

#include "results/hdf5.hpp"
#include "results/result.hpp"

namespace anticrack::results::hdf5 {
namespace {

void require_hard_link(const Handle& group, const std::string& name) {
  H5L_info_t info;
  if (H5Lget_info(group.get(), name.c_str(), &info, H5P_DEFAULT) < 0)
    throw Fault("\"" + name + "\" is missing");
  if (info.type != H5L_TYPE_HARD) throw Fault("\"" + name + "\" is a link, not data");
}

/// Whether HDF5 makes entries of one type of the other's; of records only if they are the same.
bool fits(hid_t type, hid_t wanted) {
  if (H5Tget_class(wanted) == H5T_COMPOUND) return H5Tequal(type, wanted) > 0;
  if (H5Tis_variable_str(wanted) > 0) return H5Tis_variable_str(type) > 0;
  return H5Tget_class(type) == H5Tget_class(wanted) && H5Tget_size(type) == H5Tget_size(wanted);
}

/// Reads an attribute of this many values into what room(count) gives. Texts come in HDF5's own
/// memory, which is freed here. `expected`: of the error for another type or count.
template <class Room>
void read_attribute(const Handle& object, const std::string& name, ValueType type,
                    std::uint64_t least, std::uint64_t most, const std::string& expected,
                    const Room& room) {
  const std::string what = "attribute " + name;
  const Handle id(H5Aopen(object.get(), name.c_str(), H5P_DEFAULT), H5Aclose, what + " is missing");
  // As in the file, since HDF5 does not convert between ASCII and UTF-8.
  const Handle own(H5Aget_type(id.get()), H5Tclose, what + " cannot be read");
  const Handle space(H5Aget_space(id.get()), H5Sclose, what + " cannot be read");
  // A negative one, of an error, is more than the most.
  const auto count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.get()));
  if (!fits(own.get(), type_of(type)) || count < least || count > most)
    throw Fault(what + " is not " + expected);
  void* const values = room(count);
  if (count == 0) return;
  const bool is_text = type == ValueType::text;
  std::vector<char*> texts(is_text ? count : 0, nullptr);
  if (H5Aread(id.get(), is_text ? own.get() : type_of(type), is_text ? texts.data() : values) < 0)
    throw Fault(what + " is damaged");
  auto* text = static_cast<std::string*>(values);
  for (char* from : texts) *text++ = from == nullptr ? "" : from;
  for (char* from : texts) H5free_memory(from);
}

Handle open_object(const Handle& group, const std::string& name) {
  require_hard_link(group, name);
  Handle object(H5Oopen(group.get(), name.c_str(), H5P_DEFAULT), H5Oclose,
                "dataset " + name + " is damaged");
  const H5I_type_t kind = H5Iget_type(object.get());
  if (kind == H5I_GROUP) {
    const std::vector<std::string> names = names_in(object);
    throw Fault("\"" + name + "\" is a group, not a dataset" +
                (names.empty() ? ", and has nothing in it" : "; it has " + listed(names)));
  }
  if (kind == H5I_DATATYPE) throw Fault("\"" + name + "\" is a named type, not a dataset");
  return object;
}

/// Describes the type of a file in words, for the message that another type was expected.
std::string description(hid_t type) {
  const std::string bits = std::to_string(8 * H5Tget_size(type));
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return (H5Tget_order(type) == H5T_ORDER_BE ? "big-endian float" : "float") + bits;
    case H5T_INTEGER:
      return (H5Tget_sign(type) == H5T_SGN_NONE ? "uint" : "int") + bits;
    case H5T_STRING:
      return H5Tis_variable_str(type) > 0 ? "variable-length text" : "text of a fixed length";
    case H5T_COMPOUND:
      return "a compound of several, such as complex numbers or a table";
    case H5T_ENUM:
      return "an enumeration, such as booleans";
    case H5T_ARRAY:
    case H5T_VLEN:
      return "lists of values";
    default:
      return "of another type";
  }
}

/// Throws Fault unless entries of a type can be read as of the other: of records, if they have its
/// members, and perhaps others. HDF5 refuses members that lie over each other.
void require_type(hid_t type, hid_t wanted, const std::string& what) {
  if (fits(type, wanted)) return;
  if (H5Tget_class(type) != H5T_COMPOUND || H5Tget_class(wanted) != H5T_COMPOUND)
    throw Fault(what + " is not " + description(wanted) + " but " + description(type));
  for (unsigned i = 0; i < static_cast<unsigned>(H5Tget_nmembers(wanted)); ++i) {
    char* const told = H5Tget_member_name(wanted, i);
    const std::string name(told);
    H5free_memory(told);
    const int place = H5Tget_member_index(type, name.c_str());
    if (place < 0) throw Fault(what + " has no member " + name);
    const Handle own(H5Tget_member_type(type, static_cast<unsigned>(place)), H5Tclose, what),
        other(H5Tget_member_type(wanted, i), H5Tclose, what);
    if (H5Tequal(own.get(), other.get()) <= 0)
      throw Fault(fmt::format("member {} of {} is not {} but {}", name, what,
                              description(other.get()), description(own.get())));
  }
}

/// The shape of a dataset; no extents for a single value, and for none.
Shape shape_of(const Handle& space) {
  const int rank = H5Sget_simple_extent_ndims(space.get());
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(rank, 0)));
  H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr);
  return {shape.begin(), shape.end()};
}

/// Throws Fault if HDF5 lacks a filter, lest a dataset it cannot unpack is called damaged.
void require_filters(const Handle& properties, const std::string& what) {
  const int count = H5Pget_nfilters(properties.get());
  for (int i = 0; i < count; ++i) {
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    std::array<char, 80> name{};
    const H5Z_filter_t filter =
        H5Pget_filter2(properties.get(), static_cast<unsigned>(i), &flags, &values, nullptr,
                       name.size() - 1, name.data(), &config);
    if (filter < 0 || H5Zfilter_avail(filter) > 0) continue;
    const std::string told(name.data());  // as its program called it in the file
    throw Fault(what + " is packed with " + (told.empty() ? "" : told + " (") +
                fmt::format("filter {}", filter) + (told.empty() ? "" : ")") +
                ", which this HDF5 library does not have; pack it with gzip, or not at all");
  }
}

/// Owns the texts that HDF5 reads. They take at most so many bytes, whatever lengths the file
/// claims, as many texts can be one in the file.
class Texts {
 public:
  explicit Texts(std::uint64_t most) : _left(most) {}

  /// Transfer properties by which texts are put here, not in memory that the caller has to free.
  Handle transfer() {
    Handle made(H5Pcopy(text_transfer()), H5Pclose, "HDF5 has no properties");
    const auto keep = [](void*, void*) {};
    if (H5Pset_vlen_mem_manager(made.get(), add, this, keep, nullptr) < 0)
      throw Fault("HDF5 does not take properties");
    return made;
  }

 private:
  static void* add(std::size_t size, void* self) noexcept try {
    Texts& texts = *static_cast<Texts*>(self);
    if (size > texts._left) return nullptr;
    texts._left -= size;
    return texts._texts.emplace_back(new char[size]).get();
  } catch (...) {
    return nullptr;  // no exception may cross the C library
  }

  std::uint64_t _left;
  std::vector<std::unique_ptr<char[]>> _texts;
};

/// Data is at most so much smaller packed, with deflate. Texts are not packed.
constexpr std::uint64_t largest_ratio = 1032;

}  // namespace

Handle open_root(const std::filesystem::path& path, const std::string& cure) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw Error(path.string(), "no such file", cure);
  if (status.type() != fs::file_type::regular)
    throw Error(path.string(), error ? error.message() : "is not a regular file", cure);
  const htri_t is_hdf5 = H5Fis_hdf5(path.c_str());
  if (is_hdf5 < 0) throw Error(path.string(), "cannot be opened", "check its permissions");
  if (is_hdf5 == 0) throw Error(path.string(), "is not an HDF5 file", cure);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "HDF5 does not start");
  // Reading needs no lock, and some network file systems do not support locks.
  H5Pset_file_locking(access.get(), false, true);
  const Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose,
                    "is truncated or damaged");
  return {H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose, "has no root group"};
}

std::uint64_t memory_budget(const std::filesystem::path& path) {
  return std::filesystem::file_size(path) * largest_ratio;
}

bool has(const Handle& group, const std::string& name) {
  return H5Lexists(group.get(), name.c_str(), H5P_DEFAULT) > 0;
}

bool has_attribute(const Handle& object, const std::string& name) {
  return H5Aexists(object.get(), name.c_str()) > 0;
}

Handle open_group(const Handle& parent, const std::string& name) {
  require_hard_link(parent, name);
  return {H5Gopen2(parent.get(), name.c_str(), H5P_DEFAULT), H5Gclose,
          "\"" + name + "\" is not a group"};
}

std::vector<std::string> names_in(const Handle& group) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    try {
      static_cast<std::vector<std::string>*>(list)->emplace_back(name);
      return 0;
    } catch (...) {
      return -1;  // no exception may cross the C library
    }
  };
  if (H5Literate(group.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names) < 0)
    throw Fault("a group cannot be listed");
  return names;
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 10;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
    list += (i == 0 ? "" : ", ") + names[i];
  return list + (names.size() > most ? ", ..." : "");
}

void get_attribute(const Handle& object, const std::string& name, ValueType type, void* value) {
  read_attribute(object, name, type, 1, 1, std::string("one ") + name_of(type),
                 [value](std::size_t) { return value; });
}

void get(const Handle& object, const std::string& attribute, std::vector<std::string>& texts,
         std::uint64_t most) {
  read_attribute(object, attribute, ValueType::text, 0, most, "a list of texts",
                 [&texts](std::size_t count) {
                   texts.resize(count);
                   return texts.data();
                 });
}

Dataset open_array(const Handle& group, const std::string& name, hid_t wanted, std::uint64_t budget,
                   std::string_view shape, Extents& known) {
  const std::string what = "dataset " + name;
  Handle id = open_object(group, name);
  const Handle type(H5Dget_type(id.get()), H5Tclose, what + " is damaged");
  require_type(type.get(), wanted, what);

  const Handle properties(H5Dget_create_plist(id.get()), H5Pclose, what + " is damaged");
  if (H5Pget_external_count(properties.get()) != 0 ||
      H5Pget_layout(properties.get()) == H5D_VIRTUAL)
    throw Fault(what + " lies in another file");
  require_filters(properties, what);

  const Handle space(H5Dget_space(id.get()), H5Sclose, what + " is damaged");
  Shape found = shape_of(space);
  if (!results::fits(found, shape, known)) {
    throw Fault(fmt::format("{} is not of shape ({}) but {}", what, shape,
                            H5Sget_simple_extent_type(space.get()) == H5S_NULL
                                ? "empty"
                                : fmt::format("({})", fmt::join(found, ","))));
  }
  // What is made of texts and records takes more than they do.
  const bool is_number = H5Tget_class(wanted) == H5T_FLOAT || H5Tget_class(wanted) == H5T_INTEGER;
  std::uint64_t bytes = H5Tget_size(wanted) + (is_number ? 0 : 64);
  for (const std::uint64_t extent : found)
    if (__builtin_mul_overflow(bytes, extent, &bytes) || bytes > budget)
      throw Fault(fmt::format("{} claims {} rows, more than the file can hold", what, found[0]));
  return {std::move(id), name, wanted, std::move(found)};
}

void read_values(const Dataset& dataset, void* values, hid_t transfer) {
  if (count_of(dataset.shape) != 0 &&
      H5Dread(dataset.id.get(), dataset.type, H5S_ALL, H5S_ALL, transfer, values) < 0)
    throw Fault("dataset " + dataset.name + " is damaged");
}

void get_list(const Handle& group, const std::string& name, hid_t type, std::uint64_t budget,
              const std::function<void(const std::byte* entry)>& use) {
  Extents any;
  const Dataset dataset = open_array(group, name, type, budget, "n", any);
  const std::size_t size = H5Tget_size(type);
  std::vector<std::byte> entries(dataset.shape[0] * size);
  Texts texts(budget / largest_ratio);
  read_values(dataset, entries.data(), texts.transfer().get());
  for (std::size_t at = 0; at < entries.size(); at += size) use(entries.data() + at);
}

}  // namespace anticrack::results::hdf5

// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <array>

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

bool is(const Handle& type, ValueType wanted) {
  if (wanted == ValueType::text) return H5Tis_variable_str(type.get()) > 0;
  return H5Tget_class(type.get()) == (wanted == ValueType::float64 ? H5T_FLOAT : H5T_INTEGER) &&
         H5Tget_size(type.get()) == bytes_of(wanted);
}

struct Attribute {
  Handle id;
  Handle type;  ///< as in the file, since HDF5 does not convert between ASCII and UTF-8
  hssize_t count;
};

Attribute open_attribute(const Handle& object, const std::string& name) {
  const std::string what = "attribute " + name;
  Handle id(H5Aopen(object.get(), name.c_str(), H5P_DEFAULT), H5Aclose, what + " is missing");
  Handle type(H5Aget_type(id.get()), H5Tclose, what + " cannot be read");
  const Handle space(H5Aget_space(id.get()), H5Sclose, what + " cannot be read");
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  return {std::move(id), std::move(type), count};
}

/// Fills in `count` values by calling read(type in memory, destination). Texts have HDF5's type
/// `own`; they are copied out of HDF5's memory, which is then freed.
template <class Read>
void read_entries(ValueType type, const Handle& own, std::size_t count, void* values,
                  const Read& read) {
  if (count == 0) return;
  if (type != ValueType::text) return read(native(type), values);
  std::vector<char*> pointers(count, nullptr);
  read(own.get(), pointers.data());
  auto* text = static_cast<std::string*>(values);
  for (char* pointer : pointers) *text++ = pointer == nullptr ? "" : pointer;
  for (char* pointer : pointers) H5free_memory(pointer);
}

void read_attribute(const Attribute& attribute, const std::string& name, ValueType type,
                    void* values) {
  read_entries(type, attribute.type, static_cast<std::size_t>(attribute.count), values,
               [&](hid_t memory, void* to) {
                 if (H5Aread(attribute.id.get(), memory, to) < 0)
                   throw Fault("attribute " + name + " is damaged");
               });
}

Handle open_dataset(const Handle& group, const std::string& name) {
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
std::string description(const Handle& type) {
  const std::string bits = std::to_string(8 * H5Tget_size(type.get()));
  switch (H5Tget_class(type.get())) {
    case H5T_FLOAT:
      return "float" + bits;
    case H5T_INTEGER:
      return (H5Tget_sign(type.get()) == H5T_SGN_NONE ? "uint" : "int") + bits;
    case H5T_STRING:
      return "text";
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

}  // namespace

hid_t native(ValueType type) {
  return type == ValueType::float64 ? H5T_NATIVE_DOUBLE
         : type == ValueType::int32 ? H5T_NATIVE_INT32
         : type == ValueType::int64 ? H5T_NATIVE_INT64
                                    : H5T_NATIVE_UINT8;
}

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
  constexpr std::uint64_t largest_ratio = 1032;  // to which deflate compresses
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
  const Attribute attribute = open_attribute(object, name);
  if (attribute.count != 1 || !is(attribute.type, type))
    throw Fault("attribute " + name + " is not one " + name_of(type));
  read_attribute(attribute, name, type, value);
}

void get(const Handle& object, const std::string& attribute, std::vector<std::string>& texts,
         std::uint64_t most) {
  const Attribute found = open_attribute(object, attribute);
  if (!is(found.type, ValueType::text) || found.count < 0 ||
      static_cast<std::uint64_t>(found.count) > most)
    throw Fault("attribute " + attribute + " is not a list of texts");
  texts.resize(static_cast<std::size_t>(found.count));
  read_attribute(found, attribute, ValueType::text, texts.data());
}

Dataset open_array(const Handle& group, const std::string& name, ValueType wanted,
                   std::uint64_t budget, std::string_view shape, Extents& known) {
  const std::string what = "dataset " + name;
  require_hard_link(group, name);
  Handle id = open_dataset(group, name);
  const Handle type(H5Dget_type(id.get()), H5Tclose, what + " is damaged");
  if (!is(type, wanted))
    throw Fault(what + " is not " + name_of(wanted) + " but " + description(type));

  const Handle properties(H5Dget_create_plist(id.get()), H5Pclose, what + " is damaged");
  if (H5Pget_external_count(properties.get()) != 0 ||
      H5Pget_layout(properties.get()) == H5D_VIRTUAL)
    throw Fault(what + " lies in another file");

  require_filters(properties, what);

  const Handle space(H5Dget_space(id.get()), H5Sclose, what + " is damaged");
  Shape found = shape_of(space);
  if (!fits(found, shape, known)) {
    throw Fault(fmt::format("{} is not of shape ({}) but {}", what, shape,
                            H5Sget_simple_extent_type(space.get()) == H5S_NULL
                                ? "empty"
                                : fmt::format("({})", fmt::join(found, ","))));
  }
  std::uint64_t bytes = bytes_of(wanted);
  for (const std::uint64_t extent : found)
    if (__builtin_mul_overflow(bytes, extent, &bytes) || bytes > budget)
      throw Fault(fmt::format("{} claims {} rows, more than the file can hold", what, found[0]));
  return {std::move(id), name, wanted, std::move(found)};
}

void read_values(const Dataset& dataset, void* values) {
  const std::string what = "dataset " + dataset.name + " is damaged";
  const Handle type(H5Dget_type(dataset.id.get()), H5Tclose, what);
  read_entries(dataset.type, type, count_of(dataset.shape), values, [&](hid_t memory, void* to) {
    const hid_t transfer = dataset.type == ValueType::text ? text_transfer() : H5P_DEFAULT;
    if (H5Dread(dataset.id.get(), memory, H5S_ALL, H5S_ALL, transfer, to) < 0) throw Fault(what);
  });
}

}  // namespace anticrack::results::hdf5

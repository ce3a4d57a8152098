// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <utility>

#include "results/hdf5.hpp"

namespace anticrack::results::hdf5 {
namespace {

/// Arrays of up to so many entries lie in their dataset's header, under its checksum: HDF5 writes
/// them in half the time that a chunk takes.
constexpr std::size_t compact_entries = 1024;
/// Below this number of entries compression saves next to nothing.
constexpr std::size_t compressed_from = 2048;
constexpr std::size_t chunk_entries = 65536;
/// Higher levels take several times as long and save only a twentieth of the size.
constexpr unsigned deflate_level = 1;

void require(herr_t status, const std::string& what) {
  if (status < 0) throw Fault(what);
}

/// Properties of a class with what `set` sets, whose result is below 0 on an error.
template <class Set>
Handle properties_of(hid_t property_class, const Set& set) {
  Handle properties(H5Pcreate(property_class), H5Pclose, "HDF5 has no properties");
  require(set(properties.get()), "HDF5 does not take properties");
  return properties;
}

/// What make() makes for a key. A file has thousands of datasets: the types and properties they
/// share are made once and never closed.
template <class Key, class Make>
hid_t made_once(const Key& key, const Make& make) {
  static std::map<Key, hid_t> known;
  const auto place = known.try_emplace(key, H5I_INVALID_HID).first;
  if (place->second < 0) place->second = make().release();
  return place->second;
}

Handle new_text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "HDF5 has no string type");
  require(H5Tset_size(type.get(), H5T_VARIABLE), "HDF5 has no variable-length strings");
  require(H5Tset_cset(type.get(), H5T_CSET_UTF8), "HDF5 has no UTF-8 strings");
  return type;
}

Handle new_record_type(const Members& members) {
  std::size_t size = 0;
  for (const Member& member : members) size += bytes_of(member.type);
  Handle type(H5Tcreate(H5T_COMPOUND, size), H5Tclose, "HDF5 has no records");
  std::size_t offset = 0;
  for (const Member& member : members) {
    require(H5Tinsert(type.get(), std::string(member.name).c_str(), offset, type_of(member.type)),
            "HDF5 does not take a member of records");
    offset += bytes_of(member.type);
  }
  return type;
}

/// Creation properties of a dataset of this shape with `count` numbers and texts, which may be
/// several in one place of it; 0: it has no checksum.
Handle new_creation_properties(const Shape& shape, std::uint64_t count) {
  const std::string what = "HDF5 has no creation properties";
  Handle properties = without_times(H5P_DATASET_CREATE);
  if (count == 0) return properties;
  if (count <= compact_entries) {
    require(H5Pset_layout(properties.get(), H5D_COMPACT), what);
    return properties;
  }
  std::vector<hsize_t> chunk(shape.begin(), shape.end());
  chunk[0] = std::min(shape[0], std::max<std::uint64_t>(chunk_entries / (count / shape[0]), 1));
  require(H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()), what);
  // Coordinates would save a fifth of their size in half of the time that all compression takes.
  const bool points = shape.size() == 2 && shape[1] == 2;
  if (count >= compressed_from && !points) {
    require(H5Pset_shuffle(properties.get()), what);
    require(H5Pset_deflate(properties.get(), deflate_level), what);
  }
  require(H5Pset_fletcher32(properties.get()), what);
  return properties;
}

}  // namespace

Quiet::Quiet() {
  // This has to precede all other calls of HDF5, which otherwise frees thousands of pieces one by
  // one when the program ends, though no file is open any more.
  [[maybe_unused]] static const herr_t no_cleanup = H5dont_atexit();
  H5Eget_auto2(H5E_DEFAULT, &_function, &_data);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Quiet::~Quiet() { H5Eset_auto2(H5E_DEFAULT, _function, _data); }

hid_t type_of(ValueType type) {
  static const hid_t text = new_text_type().release();
  return type == ValueType::float64 ? H5T_IEEE_F64LE
         : type == ValueType::int32 ? H5T_STD_I32LE
         : type == ValueType::int64 ? H5T_STD_I64LE
         : type == ValueType::uint8 ? H5T_STD_U8LE
                                    : text;
}

hid_t type_of(const Members& members) {
  return made_once(members, [&] { return new_record_type(members); });
}

hid_t text_transfer() {
  static const hid_t id = properties_of(H5P_DATASET_XFER, [](hid_t transfer) {
                            return H5Pset_buffer(transfer, 4096, nullptr, nullptr);
                          }).release();
  return id;
}

Handle without_times(hid_t property_class) {
  return properties_of(property_class,
                       [](hid_t creation) { return H5Pset_obj_track_times(creation, false); });
}

Handle create_group(const Handle& parent, const std::string& name, unsigned members) {
  const hid_t creation = made_once(members, [&] {
    const std::string what = "HDF5 has no creation properties";
    Handle properties = without_times(H5P_GROUP_CREATE);
    // Keeps a load's attributes and members in its header; by default HDF5 makes a heap beyond 8.
    require(H5Pset_attr_phase_change(properties.get(), 64, 32), what);
    require(H5Pset_link_phase_change(properties.get(), 32, 16), what);
    constexpr unsigned name_bytes = 10;  // of a member, on average
    require(H5Pset_est_link_info(properties.get(), members, name_bytes), what);
    return properties;
  });
  return {H5Gcreate2(parent.get(), name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose,
          "cannot create group " + name};
}

void link(const Handle& parent, const std::string& path, const Handle& group,
          const std::string& name) {
  require(H5Lcreate_hard(parent.get(), path.c_str(), group.get(), name.c_str(), H5P_DEFAULT,
                         H5P_DEFAULT),
          "cannot link " + name);
}

void put_attribute(const Handle& object, const std::string& name, ValueType type,
                   const void* values, std::optional<std::size_t> count) {
  const std::string what = "cannot write attribute " + name;
  const hsize_t extent = count.value_or(1);
  std::vector<const char*> texts;
  for (std::size_t i = 0; type == ValueType::text && i < extent; ++i)
    texts.push_back(static_cast<const std::string*>(values)[i].c_str());
  const Handle space(count ? H5Screate_simple(1, &extent, nullptr) : H5Screate(H5S_SCALAR),
                     H5Sclose, what);
  const Handle id(
      H5Acreate2(object.get(), name.c_str(), type_of(type), space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, what);
  if (extent != 0)
    require(H5Awrite(id.get(), type_of(type), texts.empty() ? values : texts.data()), what);
}

Handle put_dataset(const Handle& group, const std::string& name, hid_t type, const void* values,
                   const Shape& shape) {
  const std::string what = "cannot write dataset " + name;
  const std::vector<hsize_t> extents(shape.begin(), shape.end());
  const Handle space(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr),
                     H5Sclose, what);
  // HDF5 refuses a checksum over text alone, as it would cover only pointers into the heap.
  const bool is_text = H5Tget_class(type) == H5T_STRING;
  const bool is_record = H5Tget_class(type) == H5T_COMPOUND;
  const std::uint64_t count =
      is_text ? 0
              : count_of(shape) * (is_record ? static_cast<unsigned>(H5Tget_nmembers(type)) : 1);
  const hid_t creation =
      made_once(std::pair(shape, count), [&] { return new_creation_properties(shape, count); });
  Handle dataset(
      H5Dcreate2(group.get(), name.c_str(), type, space.get(), H5P_DEFAULT, creation, H5P_DEFAULT),
      H5Dclose, what);
  if (count_of(shape) != 0)
    require(H5Dwrite(dataset.get(), type, H5S_ALL, H5S_ALL,
                     is_text || is_record ? text_transfer() : H5P_DEFAULT, values),
            what);
  return dataset;
}

}  // namespace anticrack::results::hdf5

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include "results/hdf5.hpp"

namespace anticrack::results::hdf5 {
namespace {

constexpr std::size_t compressed_from = 2048;  // entries; compressing fewer saves little
constexpr std::size_t chunk_entries = 65536;
constexpr unsigned deflate_level = 6;

void require(herr_t status, const std::string& what) {
  if (status < 0) throw Fault(what);
}

Handle text_type() {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "HDF5 has no string type");
  require(H5Tset_size(type.get(), H5T_VARIABLE), "HDF5 has no variable-length strings");
  require(H5Tset_cset(type.get(), H5T_CSET_UTF8), "HDF5 has no UTF-8 strings");
  return type;
}

/// Values as HDF5 takes them: their types in the file and in memory, and where they are.
struct Values {
  Values(ValueType type, const void* values, std::size_t count) : text(text_type()), data(values) {
    switch (type) {
      case ValueType::float64:
        in_file = H5T_IEEE_F64LE;
        in_memory = H5T_NATIVE_DOUBLE;
        break;
      case ValueType::int32:
        in_file = H5T_STD_I32LE;
        in_memory = H5T_NATIVE_INT32;
        break;
      case ValueType::uint8:
        in_file = H5T_STD_U8LE;
        in_memory = H5T_NATIVE_UINT8;
        break;
      case ValueType::text:
        in_file = in_memory = text.get();
        for (std::size_t i = 0; i < count; ++i) {
          pointers.push_back(static_cast<const std::string*>(values)[i].c_str());
        }
        data = pointers.data();
        break;
    }
  }

  Handle text;
  std::vector<const char*> pointers;
  const void* data;
  hid_t in_file = -1, in_memory = -1;
};

Handle creation_properties(std::size_t rows, std::size_t columns, bool checked,
                           const std::string& what) {
  Handle properties = without_times(H5P_DATASET_CREATE);
  if (!checked || rows == 0) return properties;
  const std::size_t width = std::max<std::size_t>(columns, 1);
  const std::array<hsize_t, 2> chunk{
      std::min(rows, std::max<std::size_t>(chunk_entries / width, 1)), width};
  require(H5Pset_chunk(properties.get(), columns == 0 ? 1 : 2, chunk.data()), what);
  if (rows * width >= compressed_from) {
    require(H5Pset_shuffle(properties.get()), what);
    require(H5Pset_deflate(properties.get(), deflate_level), what);
  }
  require(H5Pset_fletcher32(properties.get()), what);
  return properties;
}

}  // namespace

Quiet::Quiet() {
  H5Eget_auto2(H5E_DEFAULT, &_function, &_data);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Quiet::~Quiet() {
  H5Eset_auto2(H5E_DEFAULT, _function, _data);
}

Handle without_times(hid_t property_class) {
  const std::string what = "HDF5 has no creation properties";
  Handle properties(H5Pcreate(property_class), H5Pclose, what);
  require(H5Pset_obj_track_times(properties.get(), false), what);
  return properties;
}

Handle create_group(const Handle& parent, const std::string& name) {
  const Handle creation = without_times(H5P_GROUP_CREATE);
  return {H5Gcreate2(parent.get(), name.c_str(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
          H5Gclose, "cannot create group " + name};
}

void put_attribute(const Handle& object, const std::string& name, ValueType type,
                   const void* values, std::optional<std::size_t> count) {
  const std::string what = "cannot write attribute " + name;
  const Values source(type, values, count.value_or(1));
  const hsize_t extent = count.value_or(1);
  const Handle space(count ? H5Screate_simple(1, &extent, nullptr) : H5Screate(H5S_SCALAR),
                     H5Sclose, what);
  const Handle id(
      H5Acreate2(object.get(), name.c_str(), source.in_file, space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, what);
  if (extent != 0) require(H5Awrite(id.get(), source.in_memory, source.data), what);
}

Handle put_array(const Handle& group, const std::string& name, ValueType type, const void* values,
                 std::size_t count, std::size_t columns) {
  const std::string what = "cannot write dataset " + name;
  if (columns != 0 && count % columns != 0) throw Fault(what + ": not whole rows");
  const std::size_t rows = columns == 0 ? count : count / columns;
  const std::array<hsize_t, 2> shape{rows, columns};
  const Handle space(H5Screate_simple(columns == 0 ? 1 : 2, shape.data(), nullptr), H5Sclose, what);
  const Values source(type, values, count);
  // HDF5 refuses a checksum over text, which would cover pointers into the heap.
  const Handle properties = creation_properties(rows, columns, type != ValueType::text, what);
  Handle dataset(H5Dcreate2(group.get(), name.c_str(), source.in_file, space.get(), H5P_DEFAULT,
                            properties.get(), H5P_DEFAULT),
                 H5Dclose, what);
  if (count != 0) {
    require(H5Dwrite(dataset.get(), source.in_memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, source.data),
            what);
  }
  put(dataset, "units", std::string("-"));  // quantities are in the units of the case
  return dataset;
}

}  // namespace anticrack::results::hdf5

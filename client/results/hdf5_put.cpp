// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <utility>

#include "results/hdf5.hpp"

namespace anticrack::results::hdf5 {
namespace {

/// Below this compression saves nothing to speak of.
constexpr std::size_t compressed_from = 2048;  // entries
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

Handle scalar_space() {
  return {H5Screate(H5S_SCALAR), H5Sclose, "cannot create a dataspace"};
}

void put_scalar(const Handle& object, const std::string& name, hid_t file_type, hid_t memory_type,
                const void* value) {
  const std::string what = "cannot write attribute " + name;
  const Handle space = scalar_space();
  const Handle attribute(
      H5Acreate2(object.get(), name.c_str(), file_type, space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, what);
  require(H5Awrite(attribute.get(), memory_type, value), what);
}

std::vector<const char*> pointers_to(std::span<const std::string> texts) {
  std::vector<const char*> pointers;
  pointers.reserve(texts.size());
  for (const std::string& text : texts) pointers.push_back(text.c_str());
  return pointers;
}

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

/// In the file and in memory; `text` is what text has.
std::pair<hid_t, hid_t> types_of(ValueType type, const Handle& text) {
  switch (type) {
    case ValueType::float64:
      return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE};
    case ValueType::int32:
      return {H5T_STD_I32LE, H5T_NATIVE_INT32};
    case ValueType::uint8:
      return {H5T_STD_U8LE, H5T_NATIVE_UINT8};
    case ValueType::text:
      break;
  }
  return {text.get(), text.get()};
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

void put(const Handle& object, const std::string& attribute, double value) {
  put_scalar(object, attribute, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

void put(const Handle& object, const std::string& attribute, std::int32_t value) {
  put_scalar(object, attribute, H5T_STD_I32LE, H5T_NATIVE_INT32, &value);
}

void put(const Handle& object, const std::string& attribute, const std::string& text) {
  const Handle type = text_type();
  const char* pointer = text.c_str();
  put_scalar(object, attribute, type.get(), type.get(), &pointer);
}

void put(const Handle& object, const std::string& attribute, std::span<const std::string> texts) {
  const std::string what = "cannot write attribute " + attribute;
  const Handle type = text_type();
  const std::vector<const char*> pointers = pointers_to(texts);
  const hsize_t count = pointers.size();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose, what);
  const Handle id(H5Acreate2(object.get(), attribute.c_str(), type.get(), space.get(), H5P_DEFAULT,
                             H5P_DEFAULT),
                  H5Aclose, what);
  if (count != 0) require(H5Awrite(id.get(), type.get(), pointers.data()), what);
}

Handle put_array(const Handle& group, const std::string& name, ValueType type, const void* values,
                 std::size_t count, std::size_t columns) {
  const std::string what = "cannot write dataset " + name;
  if (columns != 0 && count % columns != 0) throw Fault(what + ": not whole rows");
  const std::size_t rows = columns == 0 ? count : count / columns;
  const std::array<hsize_t, 2> shape{rows, columns};
  const Handle space(H5Screate_simple(columns == 0 ? 1 : 2, shape.data(), nullptr), H5Sclose, what);
  const Handle text = text_type();
  const auto [file_type, memory_type] = types_of(type, text);
  // A checksum over text would be one over pointers into the heap: HDF5 refuses it.
  const Handle properties = creation_properties(rows, columns, type != ValueType::text, what);
  Handle dataset(H5Dcreate2(group.get(), name.c_str(), file_type, space.get(), H5P_DEFAULT,
                            properties.get(), H5P_DEFAULT),
                 H5Dclose, what);
  std::vector<const char*> pointers;
  if (type == ValueType::text) {
    pointers = pointers_to({static_cast<const std::string*>(values), count});
    values = pointers.data();
  }
  if (count != 0) {
    require(H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), what);
  }
  put(dataset, "units", "-");  // the API has none: every quantity is in those of the case
  return dataset;
}

}  // namespace anticrack::results::hdf5

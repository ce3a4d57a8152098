// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "results/hdf5.hpp"

namespace anticrack::results::hdf5 {
namespace {

void require_hard_link(const Handle& group, const std::string& name) {
  H5L_info_t info;
  if (H5Lget_info(group.get(), name.c_str(), &info, H5P_DEFAULT) < 0) {
    throw Fault("\"" + name + "\" is missing");
  }
  if (info.type != H5L_TYPE_HARD) throw Fault("\"" + name + "\" is a link, not data");
}

bool is(const Handle& type, ValueType wanted) {
  switch (wanted) {
    case ValueType::float64:
      return H5Tget_class(type.get()) == H5T_FLOAT && H5Tget_size(type.get()) == 8;
    case ValueType::int32:
      return H5Tget_class(type.get()) == H5T_INTEGER && H5Tget_size(type.get()) == 4;
    case ValueType::uint8:
      return H5Tget_class(type.get()) == H5T_INTEGER && H5Tget_size(type.get()) == 1;
    case ValueType::text:
      return H5Tis_variable_str(type.get()) > 0;
  }
  return false;
}

/// An attribute that holds one value of the type asked for.
Handle open_scalar(const Handle& object, const std::string& name, ValueType wanted) {
  const std::string what = "attribute " + name;
  Handle attribute(H5Aopen(object.get(), name.c_str(), H5P_DEFAULT), H5Aclose,
                   what + " is missing");
  const Handle type(H5Aget_type(attribute.get()), H5Tclose, what + " cannot be read");
  const Handle space(H5Aget_space(attribute.get()), H5Sclose, what + " cannot be read");
  if (H5Sget_simple_extent_npoints(space.get()) != 1 || !is(type, wanted)) {
    throw Fault(what + " is not one " + name_of(wanted));
  }
  return attribute;
}

void read_scalar(const Handle& attribute, const std::string& name, hid_t type, void* value) {
  if (H5Aread(attribute.get(), type, value) < 0) throw Fault("attribute " + name + " is damaged");
}

/// Copies the texts that HDF5 allocated, and frees them.
void take(const std::vector<char*>& pointers, std::string* texts) {
  for (char* pointer : pointers) *texts++ = pointer == nullptr ? "" : pointer;
  for (char* pointer : pointers) H5free_memory(pointer);
}

}  // namespace

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
      return -1;  // an exception may not cross the C library
    }
  };
  if (H5Literate(group.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names) < 0) {
    throw Fault("a group cannot be listed");
  }
  return names;
}

void get(const Handle& object, const std::string& attribute, double& value) {
  read_scalar(open_scalar(object, attribute, ValueType::float64), attribute, H5T_NATIVE_DOUBLE,
              &value);
}

void get(const Handle& object, const std::string& attribute, std::int32_t& value) {
  read_scalar(open_scalar(object, attribute, ValueType::int32), attribute, H5T_NATIVE_INT32,
              &value);
}

void get(const Handle& object, const std::string& attribute, std::string& value) {
  const Handle id = open_scalar(object, attribute, ValueType::text);
  // Its own type: HDF5 does not convert between ASCII and UTF-8.
  const Handle type(H5Aget_type(id.get()), H5Tclose, "attribute " + attribute + " is damaged");
  char* text = nullptr;
  read_scalar(id, attribute, type.get(), &text);
  take({text}, &value);
}

void get(const Handle& object, const std::string& attribute, std::vector<std::string>& texts,
         std::uint64_t most) {
  const std::string what = "attribute " + attribute;
  const Handle id(H5Aopen(object.get(), attribute.c_str(), H5P_DEFAULT), H5Aclose,
                  what + " is missing");
  const Handle type(H5Aget_type(id.get()), H5Tclose, what + " is damaged");
  const Handle space(H5Aget_space(id.get()), H5Sclose, what + " is damaged");
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (!is(type, ValueType::text) || count < 0 || static_cast<std::uint64_t>(count) > most) {
    throw Fault(what + " is not a list of texts");
  }
  std::vector<char*> pointers(static_cast<std::size_t>(count), nullptr);
  if (!pointers.empty()) read_scalar(id, attribute, type.get(), pointers.data());
  texts.resize(pointers.size());
  take(pointers, texts.data());
}

Dataset open_array(const Handle& group, const std::string& name, ValueType wanted,
                   std::uint64_t budget, std::size_t columns) {
  const std::string what = "dataset " + name;
  require_hard_link(group, name);
  Handle id(H5Dopen2(group.get(), name.c_str(), H5P_DEFAULT), H5Dclose, what + " is damaged");
  const Handle type(H5Dget_type(id.get()), H5Tclose, what + " is damaged");
  if (!is(type, wanted)) throw Fault(what + " is not " + name_of(wanted));

  const Handle properties(H5Dget_create_plist(id.get()), H5Pclose, what + " is damaged");
  if (H5Pget_external_count(properties.get()) != 0 ||
      H5Pget_layout(properties.get()) == H5D_VIRTUAL) {
    throw Fault(what + " lies in another file");
  }

  const Handle space(H5Dget_space(id.get()), H5Sclose, what + " is damaged");
  const int rank = columns == 0 ? 1 : 2;
  std::array<hsize_t, 2> shape{0, 0};
  if (H5Sget_simple_extent_type(space.get()) != H5S_SIMPLE ||
      H5Sget_simple_extent_ndims(space.get()) != rank ||
      H5Sget_simple_extent_dims(space.get(), shape.data(), nullptr) != rank ||
      (columns != 0 && columns != any_columns && shape[1] != columns)) {
    throw Fault(what + " is not of shape " +
                (columns == 0             ? std::string("(n)")
                 : columns == any_columns ? std::string("(rows,columns)")
                                          : "(n," + std::to_string(columns) + ")"));
  }
  const hsize_t width = columns == 0 ? 1 : shape[1];
  const std::uint64_t entries = budget / bytes_of(wanted);
  if (width > entries || (width > 0 && shape[0] > entries / width)) {
    throw Fault(what + " claims " + std::to_string(shape[0]) +
                " rows, more than the file can hold");
  }
  return {std::move(id), name, wanted, static_cast<std::size_t>(shape[0]),
          static_cast<std::size_t>(width)};
}

void read_values(const Dataset& dataset, void* values) {
  if (dataset.count() == 0) return;
  const std::string what = "dataset " + dataset.name + " is damaged";
  const auto read_as = [&](hid_t type, void* into) {
    if (H5Dread(dataset.id.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, into) < 0) throw Fault(what);
  };
  switch (dataset.type) {
    case ValueType::float64:
      return read_as(H5T_NATIVE_DOUBLE, values);
    case ValueType::int32:
      return read_as(H5T_NATIVE_INT32, values);
    case ValueType::uint8:
      return read_as(H5T_NATIVE_UINT8, values);
    case ValueType::text:
      break;
  }
  const Handle type(H5Dget_type(dataset.id.get()), H5Tclose, what);
  std::vector<char*> pointers(dataset.count(), nullptr);
  read_as(type.get(), pointers.data());
  take(pointers, static_cast<std::string*>(values));
}

}  // namespace anticrack::results::hdf5

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

enum class Element { float64, int32, uint8, text };

bool is(const Handle& type, Element element) {
  switch (element) {
    case Element::float64:
      return H5Tget_class(type.get()) == H5T_FLOAT && H5Tget_size(type.get()) == 8;
    case Element::int32:
      return H5Tget_class(type.get()) == H5T_INTEGER && H5Tget_size(type.get()) == 4;
    case Element::uint8:
      return H5Tget_class(type.get()) == H5T_INTEGER && H5Tget_size(type.get()) == 1;
    case Element::text:
      return H5Tis_variable_str(type.get()) > 0;
  }
  return false;
}

const char* name_of(Element element) {
  switch (element) {
    case Element::float64:
      return "float64";
    case Element::int32:
      return "int32";
    case Element::uint8:
      return "uint8";
    case Element::text:
      return "variable-length text";
  }
  return "";
}

/// An attribute that holds one value of the type asked for.
Handle open_scalar(const Handle& object, const std::string& name, Element element) {
  const std::string what = "attribute " + name;
  Handle attribute(H5Aopen(object.get(), name.c_str(), H5P_DEFAULT), H5Aclose,
                   what + " is missing");
  const Handle type(H5Aget_type(attribute.get()), H5Tclose, what + " cannot be read");
  const Handle space(H5Aget_space(attribute.get()), H5Sclose, what + " cannot be read");
  if (H5Sget_simple_extent_npoints(space.get()) != 1 || !is(type, element)) {
    throw Fault(what + " is not one " + name_of(element));
  }
  return attribute;
}

/// Of entries of variable length this is the pointer to them.
std::uint64_t bytes_of(Element element) {
  return element == Element::int32 ? 4 : element == Element::uint8 ? 1 : 8;
}

constexpr std::size_t any_columns = static_cast<std::size_t>(-1);

struct Dataset {
  Handle id;
  std::size_t rows;
  std::size_t columns;  // 1 for one dimension

  std::size_t count() const { return rows * columns; }
};

/// A dataset of the type and shape asked for that fits the budget; nothing is allocated for it yet.
Dataset open_array(const Handle& group, const std::string& name, Element element,
                   std::uint64_t budget, std::size_t columns) {
  const std::string what = "dataset " + name;
  require_hard_link(group, name);
  Handle id(H5Dopen2(group.get(), name.c_str(), H5P_DEFAULT), H5Dclose, what + " is damaged");
  const Handle type(H5Dget_type(id.get()), H5Tclose, what + " is damaged");
  if (!is(type, element)) throw Fault(what + " is not " + name_of(element));

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
  const std::uint64_t entries = budget / bytes_of(element);
  if (width > entries || (width > 0 && shape[0] > entries / width)) {
    throw Fault(what + " claims " + std::to_string(shape[0]) +
                " rows, more than the file can hold");
  }
  return {std::move(id), static_cast<std::size_t>(shape[0]), static_cast<std::size_t>(width)};
}

template <typename T>
std::vector<T> values_of(const Dataset& dataset, const std::string& name, hid_t memory_type) {
  std::vector<T> values(dataset.count());
  if (!values.empty() &&
      H5Dread(dataset.id.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    throw Fault("dataset " + name + " is damaged");
  }
  return values;
}

template <typename T>
std::vector<T> read_numbers(const Handle& group, const std::string& name, Element element,
                            hid_t memory_type, std::uint64_t budget, std::size_t columns) {
  return values_of<T>(open_array(group, name, element, budget, columns), name, memory_type);
}

/// The texts that HDF5 allocated, and frees them.
std::vector<std::string> taken(const std::vector<char*>& pointers) {
  std::vector<std::string> values;
  values.reserve(pointers.size());
  for (char* pointer : pointers) values.emplace_back(pointer == nullptr ? "" : pointer);
  for (char* pointer : pointers) H5free_memory(pointer);
  return values;
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

double get_double(const Handle& object, const std::string& attribute) {
  const Handle id = open_scalar(object, attribute, Element::float64);
  double value = 0;
  if (H5Aread(id.get(), H5T_NATIVE_DOUBLE, &value) < 0) {
    throw Fault("attribute " + attribute + " is damaged");
  }
  return value;
}

std::int32_t get_int(const Handle& object, const std::string& attribute) {
  const Handle id = open_scalar(object, attribute, Element::int32);
  std::int32_t value = 0;
  if (H5Aread(id.get(), H5T_NATIVE_INT32, &value) < 0) {
    throw Fault("attribute " + attribute + " is damaged");
  }
  return value;
}

std::string get_text(const Handle& object, const std::string& attribute) {
  const Handle id = open_scalar(object, attribute, Element::text);
  // Its own type: HDF5 does not convert between ASCII and UTF-8.
  const Handle type(H5Aget_type(id.get()), H5Tclose, "attribute " + attribute + " is damaged");
  char* text = nullptr;
  if (H5Aread(id.get(), type.get(), &text) < 0) {
    throw Fault("attribute " + attribute + " is damaged");
  }
  std::string value = text == nullptr ? "" : text;
  H5free_memory(text);
  return value;
}

std::vector<std::string> get_text_list(const Handle& object, const std::string& attribute,
                                       std::uint64_t most) {
  const std::string what = "attribute " + attribute;
  const Handle id(H5Aopen(object.get(), attribute.c_str(), H5P_DEFAULT), H5Aclose,
                  what + " is missing");
  const Handle type(H5Aget_type(id.get()), H5Tclose, what + " is damaged");
  const Handle space(H5Aget_space(id.get()), H5Sclose, what + " is damaged");
  const hssize_t count = H5Sget_simple_extent_npoints(space.get());
  if (!is(type, Element::text) || count < 0 || static_cast<std::uint64_t>(count) > most) {
    throw Fault(what + " is no list of texts");
  }
  std::vector<char*> pointers(static_cast<std::size_t>(count), nullptr);
  if (!pointers.empty() && H5Aread(id.get(), type.get(), pointers.data()) < 0) {
    throw Fault(what + " is damaged");
  }
  return taken(pointers);
}

std::vector<double> get_doubles(const Handle& group, const std::string& name, std::uint64_t budget,
                                std::size_t columns) {
  return read_numbers<double>(group, name, Element::float64, H5T_NATIVE_DOUBLE, budget, columns);
}

std::vector<std::int32_t> get_ints(const Handle& group, const std::string& name,
                                   std::uint64_t budget, std::size_t columns) {
  return read_numbers<std::int32_t>(group, name, Element::int32, H5T_NATIVE_INT32, budget, columns);
}

std::vector<std::uint8_t> get_bytes(const Handle& group, const std::string& name,
                                    std::uint64_t budget, std::size_t columns) {
  return read_numbers<std::uint8_t>(group, name, Element::uint8, H5T_NATIVE_UINT8, budget, columns);
}

Rows get_rows(const Handle& group, const std::string& name, std::uint64_t budget) {
  const Dataset dataset = open_array(group, name, Element::float64, budget, any_columns);
  return {values_of<double>(dataset, name, H5T_NATIVE_DOUBLE), dataset.rows, dataset.columns};
}

std::vector<std::string> get_texts(const Handle& group, const std::string& name,
                                   std::uint64_t budget) {
  const Dataset dataset = open_array(group, name, Element::text, budget, 0);
  std::vector<char*> pointers(dataset.count(), nullptr);
  const Handle type(H5Dget_type(dataset.id.get()), H5Tclose, "dataset " + name + " is damaged");
  if (!pointers.empty() &&
      H5Dread(dataset.id.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0) {
    throw Fault("dataset " + name + " is damaged");
  }
  return taken(pointers);
}

}  // namespace anticrack::results::hdf5

// SPDX-License-Identifier: GPL-3.0-or-later
//
// A reader of .vtu files that trusts nothing the writer says: it goes by the XML and the lengths in
// front of the arrays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace anticrack::vtk {

struct ReadArray {
  std::string type, section;
  std::size_t components = 0;
  std::string bytes;

  template <class T>
  std::vector<T> as() const {
    if (bytes.size() % sizeof(T) != 0) throw std::runtime_error("not whole values");
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
};

struct ReadVtu {
  std::size_t points = 0, cells = 0;
  std::map<std::string, ReadArray> arrays;
};

inline std::string attribute_of(const std::string& element, const std::string& name) {
  const std::string before = " " + name + "=\"";
  const std::size_t begin = element.find(before);
  const std::size_t end = element.find('"', begin + before.size());
  if (begin == std::string::npos || end == std::string::npos) {
    throw std::runtime_error("no attribute " + name + " in " + element);
  }
  return element.substr(begin + before.size(), end - begin - before.size());
}

inline std::string array_at(const std::string& data, std::size_t offset) {
  std::uint64_t length = 0;
  if (offset + 8 > data.size()) throw std::runtime_error("offset outside the data");
  std::memcpy(&length, data.data() + offset, 8);
  if (length > data.size() - offset - 8) throw std::runtime_error("length outside the data");
  return data.substr(offset + 8, length);
}

/// Throws for what is not VTK XML with raw appended data, or has an element that does not close.
inline ReadVtu read_vtu(const std::string& file) {
  const std::string begin = "<AppendedData encoding=\"raw\">\n_";
  const std::string end = "\n  </AppendedData>\n</VTKFile>\n";
  const std::size_t cut = file.find(begin);
  if (cut == std::string::npos || !file.ends_with(end)) throw std::runtime_error("no raw data");
  const std::string data =
      file.substr(cut + begin.size(), file.size() - cut - begin.size() - end.size());
  const std::string xml = file.substr(0, cut);
  ReadVtu result;
  std::vector<std::string> open;
  for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
    const std::string tag = xml.substr(at + 1, xml.find('>', at) - at - 1);
    if (tag.starts_with("?")) continue;
    const bool closes = tag.starts_with("/"), empty = tag.ends_with("/");
    const std::size_t name_end = std::min(tag.find(' '), tag.size() - (empty ? 1 : 0));
    const std::string name = tag.substr(closes ? 1 : 0, name_end - (closes ? 1 : 0));
    const std::string attributes = tag.substr(name_end);
    if (closes) {
      if (open.empty() || open.back() != name) throw std::runtime_error("</" + name + ">");
      open.pop_back();
      continue;
    }
    if (name == "VTKFile" && (attribute_of(attributes, "byte_order") != "LittleEndian" ||
                              attribute_of(attributes, "header_type") != "UInt64")) {
      throw std::runtime_error("another byte order or width");
    }
    if (name == "Piece") {
      result.points = std::stoul(attribute_of(attributes, "NumberOfPoints"));
      result.cells = std::stoul(attribute_of(attributes, "NumberOfCells"));
    }
    if (name == "DataArray") {
      result.arrays[attribute_of(attributes, "Name")] = {
          attribute_of(attributes, "type"), open.back(),
          std::stoul(attribute_of(attributes, "NumberOfComponents")),
          array_at(data, std::stoul(attribute_of(attributes, "offset")))};
    }
    if (!empty) open.push_back(name);
  }
  if (open != std::vector<std::string>{"VTKFile"}) throw std::runtime_error("unclosed elements");
  return result;
}

}  // namespace anticrack::vtk

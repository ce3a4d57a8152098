// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesher/msh_writer.hpp"

#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace anticrack::testing {
namespace {

/// Writes numbers as text or as they lie in memory.
class Out {
 public:
  explicit Out(bool binary) : _binary(binary) { _text.precision(17); }
  template <class T>
  Out& number(T value) {
    if (_binary) {
      _text.write(reinterpret_cast<const char*>(&value), sizeof value);
    } else {
      _text << value << ' ';
    }
    return *this;
  }
  Out& text(const std::string& value) {
    _text << value;
    return *this;
  }
  Out& end_line() {
    if (!_binary) _text << '\n';
    return *this;
  }
  std::string take() const { return _text.str(); }

 private:
  bool _binary;
  std::ostringstream _text;
};

void write_head(Out& out, const MshSample& sample, const char* version, bool binary) {
  out.text(std::string("$MeshFormat\n") + version + (binary ? " 1 8\n" : " 0 8\n"));
  if (binary) out.number(std::int32_t{1}).text("\n");
  out.text("$EndMeshFormat\n");
  if (sample.names.empty()) return;
  out.text("$PhysicalNames\n" + std::to_string(sample.names.size()) + "\n");
  for (const MshName& n : sample.names) {
    out.text(std::to_string(n.dimension) + " " + std::to_string(n.tag) + " \"" + n.name + "\"\n");
  }
  out.text("$EndPhysicalNames\n");
}

template <class Element>
void write_22_elements(Out& out, const std::vector<Element>& elements, int type, bool binary,
                       std::int32_t& tag) {
  if (elements.empty()) return;
  if (binary) {
    out.number<std::int32_t>(type)
        .number(static_cast<std::int32_t>(elements.size()))
        .number<std::int32_t>(2);
  }
  for (const Element& e : elements) {
    out.number<std::int32_t>(tag++);
    if (!binary) out.number<std::int32_t>(type).number<std::int32_t>(2);
    for (const std::int32_t value : {e.group, e.entity}) out.number(value);
    for (const int node : e.nodes) out.number<std::int32_t>(node);
    out.end_line();
  }
}

std::string write_22(const MshSample& sample, bool binary) {
  Out out(binary);
  write_head(out, sample, "2.2", binary);
  out.text("$Nodes\n" + std::to_string(sample.tags.size()) + "\n");
  for (std::size_t i = 0; i < sample.tags.size(); ++i) {
    out.number<std::int32_t>(sample.tags[i]);
    for (const double value : sample.points[i]) out.number(value);
    out.end_line();
  }
  out.text(binary ? "\n$EndNodes\n$Elements\n" : "$EndNodes\n$Elements\n");
  out.text(std::to_string(sample.lines.size() + sample.triangles.size()) + "\n");
  std::int32_t tag = 1;
  write_22_elements(out, sample.lines, 1, binary, tag);
  write_22_elements(out, sample.triangles, 2, binary, tag);
  out.text(binary ? "\n$EndElements\n" : "$EndElements\n");
  return out.take();
}

/// Physical group and number of elements of each entity, in order.
template <class Element>
std::map<int, std::pair<int, std::uint64_t>> entities(const std::vector<Element>& elements) {
  std::map<int, std::pair<int, std::uint64_t>> found;
  for (const Element& e : elements) {
    auto& [group, count] = found[e.entity];
    group = e.group;
    ++count;
  }
  return found;
}

template <class Element>
void write_41_entities(Out& out, const std::vector<Element>& elements) {
  for (const auto& [entity, facts] : entities(elements)) {
    out.number<std::int32_t>(entity);
    for (int i = 0; i < 6; ++i) out.number(0.0);
    out.number<std::uint64_t>(facts.first == 0 ? 0 : 1);
    if (facts.first != 0) out.number<std::int32_t>(facts.first);
    out.number<std::uint64_t>(1).number<std::int32_t>(77);
    out.end_line();
  }
}

template <class Element>
void write_41_elements(Out& out, const std::vector<Element>& elements, int dimension,
                       std::uint64_t& tag) {
  for (const auto& [entity, facts] : entities(elements)) {
    out.number<std::int32_t>(dimension).number<std::int32_t>(entity);
    out.number<std::int32_t>(dimension).number(facts.second).end_line();
    for (const Element& e : elements) {
      if (e.entity != entity) continue;
      out.number(tag++);
      for (const int node : e.nodes) out.number(static_cast<std::uint64_t>(node));
      out.end_line();
    }
  }
}

std::string write_41(const MshSample& sample, bool binary) {
  Out out(binary);
  write_head(out, sample, "4.1", binary);
  const std::uint64_t curves = entities(sample.lines).size();
  const std::uint64_t surfaces = entities(sample.triangles).size();
  const std::string end = binary ? "\n" : "";
  out.text("$Entities\n");
  out.number<std::uint64_t>(1).number(curves).number(surfaces).number<std::uint64_t>(0).end_line();
  out.number<std::int32_t>(77);
  for (int i = 0; i < 3; ++i) out.number(0.0);
  out.number<std::uint64_t>(0).end_line();
  write_41_entities(out, sample.lines);
  write_41_entities(out, sample.triangles);
  out.text(end + "$EndEntities\n$Nodes\n");
  const std::uint64_t nodes = sample.tags.size();
  // two blocks, the second with parameters on its surface
  const std::uint64_t first = nodes / 2;
  out.number<std::uint64_t>(2).number(nodes).number<std::uint64_t>(1).number<std::uint64_t>(nodes);
  out.end_line();
  for (const bool second : {false, true}) {
    const std::uint64_t begin = second ? first : 0;
    const std::uint64_t stop = second ? nodes : first;
    out.number<std::int32_t>(2).number<std::int32_t>(1).number<std::int32_t>(second ? 1 : 0);
    out.number(stop - begin).end_line();
    for (auto i = begin; i < stop; ++i)
      out.number(static_cast<std::uint64_t>(sample.tags[i])).end_line();
    for (auto i = begin; i < stop; ++i) {
      for (const double value : sample.points[i]) out.number(value);
      if (second) out.number(0.25).number(0.75);
      out.end_line();
    }
  }
  out.text(end + "$EndNodes\n$Elements\n");
  out.number(curves + surfaces);
  out.number<std::uint64_t>(sample.lines.size() + sample.triangles.size());
  out.number<std::uint64_t>(1).number<std::uint64_t>(1).end_line();
  std::uint64_t tag = 1;
  write_41_elements(out, sample.lines, 1, tag);
  write_41_elements(out, sample.triangles, 2, tag);
  out.text(end + "$EndElements\n");
  return out.take();
}

}  // namespace

int& MshSample::node(double x, double y) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i][0] == x && points[i][1] == y) return tags[i];
  }
  throw std::out_of_range("no node there");
}

std::string write_msh(const MshSample& sample, MshFormat format) {
  switch (format) {
    case MshFormat::ascii22:
      return write_22(sample, false);
    case MshFormat::binary22:
      return write_22(sample, true);
    case MshFormat::ascii41:
      return write_41(sample, false);
    default:
      return write_41(sample, true);
  }
}

MshSample square_sample(const std::string& middle) {
  MshSample sample;
  const auto tag = [](int i, int j) { return 10 * (5 * j + i + 1); };
  for (int j = 0; j < 5; ++j) {
    for (int i = 0; i < 5; ++i) {
      sample.tags.push_back(tag(i, j));
      sample.points.push_back({-1 + 0.5 * i, -1 + 0.5 * j, 0});
    }
  }
  for (int i = 0; i < 4; ++i) sample.lines.push_back({{tag(i, 0), tag(i + 1, 0)}, 3, 11});
  for (int j = 0; j < 4; ++j) sample.lines.push_back({{tag(4, j), tag(4, j + 1)}, 3, 11});
  for (int i = 4; i > 0; --i) sample.lines.push_back({{tag(i, 4), tag(i - 1, 4)}, 3, 11});
  for (int j = 4; j > 0; --j) sample.lines.push_back({{tag(0, j), tag(0, j - 1)}, 3, 11});
  sample.names = {{2, 1, "minus"}, {2, 2, "plus"}, {1, 3, "dirichlet"}};
  if (!middle.empty()) {
    for (int i = 1; i < 3; ++i) sample.lines.push_back({{tag(i, 2), tag(i + 1, 2)}, 4, 12});
    sample.names.push_back({1, 4, middle});
  }
  for (int j = 0; j < 4; ++j) {
    const int surface = j < 2 ? 1 : 2;
    for (int i = 0; i < 4; ++i) {
      const int a = tag(i, j);
      const int b = tag(i + 1, j);
      const int c = tag(i + 1, j + 1);
      const int d = tag(i, j + 1);
      sample.triangles.push_back({{a, b, c}, surface, surface + 20});
      sample.triangles.push_back({{a, c, d}, surface, surface + 20});
    }
  }
  return sample;
}

void save(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace anticrack::testing

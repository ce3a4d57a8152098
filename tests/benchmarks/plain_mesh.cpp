// SPDX-License-Identifier: GPL-3.0-or-later
#include "benchmarks/plain_mesh.hpp"

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace anticrack::benchmarks {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr std::array<char, 8> magic = {'A', 'C', 'M', 'E', 'S', 'H', '1', '\n'};

template <class T>
void put(std::ofstream& file, const std::vector<T>& values) {
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(T)));
}

void put_length(std::ofstream& file, std::size_t length) {
  put(file, std::vector<std::int64_t>{static_cast<std::int64_t>(length)});
}

class Reader {
 public:
  explicit Reader(const std::string& path) : _path(path), _file(path, std::ios::binary) {
    std::array<char, 8> first{};
    std::error_code none;
    _left = std::filesystem::file_size(path, none);
    if (!_file.read(first.data(), first.size()) || first != magic) {
      throw std::runtime_error(path + " is not a mesh of the benchmarks");
    }
  }

  std::size_t length() {
    std::int64_t value = 0;
    take(reinterpret_cast<char*>(&value), sizeof value);
    return static_cast<std::size_t>(value);
  }

  template <class T>
  std::vector<T> array(std::size_t length) {
    if (length > _left / sizeof(T)) throw std::runtime_error(_path + " is cut short");
    std::vector<T> values(length);
    take(reinterpret_cast<char*>(values.data()), length * sizeof(T));
    return values;
  }

 private:
  void take(char* to, std::size_t bytes) {
    if (!_file.read(to, static_cast<std::streamsize>(bytes))) {
      throw std::runtime_error(_path + " is cut short");
    }
  }

  std::string _path;
  std::ifstream _file;
  std::uintmax_t _left = 0;
};

}  // namespace

void write(const PlainMesh& mesh, const std::string& path) {
  std::ofstream file(path, std::ios::binary);
  file.write(magic.data(), magic.size());
  for (const std::size_t length : {mesh.xy.size(), mesh.triangles.size(), mesh.subdomain.size(),
                                   mesh.dirichlet.size(), mesh.chains.size()}) {
    put_length(file, length);
  }
  put(file, mesh.xy);
  put(file, mesh.triangles);
  put(file, mesh.subdomain);
  put(file, mesh.dirichlet);
  for (const PlainMesh::Chain& chain : mesh.chains) {
    put_length(file, chain.nodes.size());
    put(file, chain.nodes);
    put(file, chain.kind);
    put(file, chain.inclusion);
  }
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

PlainMesh read_plain_mesh(const std::string& path) {
  Reader reader(path);
  const std::size_t xy = reader.length(), triangles = reader.length(), subdomain = reader.length(),
                    dirichlet = reader.length(), chains = reader.length();
  PlainMesh mesh;
  mesh.xy = reader.array<double>(xy);
  mesh.triangles = reader.array<std::int32_t>(triangles);
  mesh.subdomain = reader.array<std::int32_t>(subdomain);
  mesh.dirichlet = reader.array<std::int32_t>(dirichlet);
  for (std::size_t c = 0; c < chains; ++c) {
    const std::size_t nodes = reader.length();
    if (nodes == 0) throw std::runtime_error(path + " has an interface without nodes");
    PlainMesh::Chain chain;
    chain.nodes = reader.array<std::int32_t>(nodes);
    chain.kind = reader.array<std::int32_t>(nodes - 1);
    chain.inclusion = reader.array<std::int32_t>(nodes - 1);
    mesh.chains.push_back(std::move(chain));
  }
  return mesh;
}

double force(int number, double x, double y) {
  const double k = number;
  return std::sin(1.3 * x + (2.0 + 0.11 * k) * y + 0.7 * k);
}

double combination(int row, int j) { return std::cos((0.01 + 0.003 * j) * row + 0.9 * j); }

std::vector<double> nodal_force(const PlainMesh& mesh, int number) {
  std::vector<double> values(mesh.node_count());
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = force(number, mesh.xy[2 * i], mesh.xy[2 * i + 1]);
  }
  return values;
}

}  // namespace anticrack::benchmarks

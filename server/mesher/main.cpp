// SPDX-License-Identifier: GPL-3.0-or-later
//
// anticrack-mesher MEMORY_BYTES CPU_SECONDS OPEN_FILES: one mesh::MesherRequest on standard input,
// one mesh::MesherReply on standard output, and an end.
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <iostream>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>

#include "mesh/codec.hpp"
#include "mesher/generate.hpp"
#include "mesher/grading.hpp"
#include "mesher/import.hpp"
#include "mesher/limits.hpp"

namespace {

using namespace anticrack;

std::optional<std::uint64_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value == 0) return std::nullopt;
  return value;
}

mesh::Bytes read_all(int descriptor) {
  mesh::Bytes bytes;
  std::size_t used = 0;
  for (;;) {
    bytes.resize(used + 65536);
    const ssize_t n = read(descriptor, bytes.data() + used, bytes.size() - used);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw std::system_error(errno, std::system_category(), "standard input");
    used += static_cast<std::size_t>(n);
    if (n == 0) break;
  }
  bytes.resize(used);
  return bytes;
}

void write_all(int descriptor, const mesh::Bytes& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = write(descriptor, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw std::system_error(errno, std::system_category(), "standard output");
    done += static_cast<std::size_t>(n);
  }
}

mesh::MesherReply answer(std::uint64_t memory) {
  try {
    const mesh::MesherRequest request = mesh::decode_request(read_all(STDIN_FILENO));
    if (const auto* wanted = std::get_if<mesh::GenerateRequest>(&request)) {
      return mesher::graded(mesher::generate(*wanted), wanted->plan.grading, wanted->max_triangles);
    }
    const auto& file = std::get<mesh::ImportRequest>(request);
    return mesher::graded(mesher::import_msh(file), file.options, file.max_triangles);
  } catch (const errors::Error& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return errors::Error(errors::Reason::mesher_failed,
                         "the mesher ran out of its " + std::to_string(memory >> 20) +
                             " MiB of memory; choose a coarser mesh or give it more");
  } catch (const std::exception& error) {
    return errors::Error(errors::Reason::mesher_failed,
                         std::string("the mesher failed: ") + error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::optional<std::uint64_t> values[3];
  for (int i = 0; i < 3 && argc == 4; ++i) values[i] = number(argv[i + 1]);
  if (!values[0] || !values[1] || !values[2]) {
    std::cerr << "usage: anticrack-mesher MEMORY_BYTES CPU_SECONDS OPEN_FILES\n"
                 "Meshes the one request on its standard input; the server starts it.\n";
    return 2;
  }
  try {
    mesher::restrict_process({*values[0], *values[1], *values[2]});
    write_all(STDOUT_FILENO, mesh::encode(answer(*values[0])));
  } catch (const std::exception& error) {
    std::cerr << "anticrack-mesher: " << error.what() << '\n';
    return 1;
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
//
// anticrack-mesher MEMORY_BYTES CPU_SECONDS generate|import: reads one mesh::MesherRequest from
// standard input and writes one mesh::MesherReply to standard output. The .msh to import is
// descriptor 3. Limits and filter are set before any input is read.
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <iostream>
#include <new>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include "mesh/codec.hpp"
#include "mesher/child.hpp"
#include "mesher/generate.hpp"
#include "mesher/grading.hpp"
#include "mesher/helper.hpp"
#include "mesher/import.hpp"
#include "mesher/progress.hpp"
#include "mesher/restrict.hpp"
#include "stop/stop.hpp"

namespace {

using namespace anticrack;

std::optional<std::uint64_t> parse_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value == 0) return std::nullopt;
  return value;
}

mesh::Bytes read_all(int descriptor, const char* name) {
  constexpr std::size_t step = 1U << 18;
  mesh::Bytes bytes;
  std::size_t used = 0;
  for (;;) {
    bytes.resize(used + step);
    const ssize_t n = read(descriptor, bytes.data() + used, bytes.size() - used);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw std::system_error(errno, std::system_category(), name);
    used += static_cast<std::size_t>(n);
    if (n == 0) break;
  }
  bytes.resize(used);
  return bytes;
}

void write_all(int descriptor, std::span<const std::byte> bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = write(descriptor, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw std::system_error(errno, std::system_category(), "standard output");
    done += static_cast<std::size_t>(n);
  }
}

/// Writes the progress when the work first looks at its stop token, and then about once a second.
class Reporter {
 public:
  bool operator()(const stop::Look& at) {
    const auto now = Clock::now();
    if (now < _next) return false;
    _next = now + pause;
    write_all(STDOUT_FILENO, mesher::encode(mesher::Progress{at.doing, at.done}));
    return false;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds pause{700};
  Clock::time_point _next;
};

template <class Wanted>
Wanted request() {
  mesh::MesherRequest any = mesh::decode_request(read_all(STDIN_FILENO, "standard input"));
  if (auto* wanted = std::get_if<Wanted>(&any)) return std::move(*wanted);
  throw errors::Error(errors::Reason::internal, "the request is not of the kind announced");
}

mesh::Mesh generated() {
  const mesher::Gmsh gmsh;
  mesher::forbid_system_calls();
  const auto wanted = request<mesh::GenerateRequest>();
  return mesher::graded(mesher::generate(gmsh, wanted), wanted.plan.grading, wanted.max_triangles);
}

mesh::Mesh imported() {
  mesher::forbid_system_calls();
  const auto wanted = request<mesh::ImportRequest>();
  const mesh::Bytes file = read_all(mesher::Child::file_descriptor, "the mesh file");
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  return mesher::graded(mesher::import_msh(text, wanted.options, wanted.max_triangles),
                        wanted.options, wanted.max_triangles);
}

mesh::MesherReply answer(bool import, std::uint64_t memory) {
  try {
    return import ? imported() : generated();
  } catch (const errors::Error& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return errors::Error(errors::Reason::mesher_failed,
                         "the mesher ran out of its {} MiB of memory; choose a coarser "
                         "mesh (larger size or tip_size) "
                         "or raise the limit",
                         memory >> 20);
  } catch (const std::exception& error) {
    return errors::Error(errors::Reason::mesher_failed, "the mesher failed: {}", error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view kind = argc == 4 ? argv[3] : "";
  const bool import = kind == "import";
  const auto memory = argc == 4 ? parse_number(argv[1]) : std::nullopt;
  const auto seconds = argc == 4 ? parse_number(argv[2]) : std::nullopt;
  if (!memory || !seconds || (!import && kind != "generate")) {
    std::cerr << mesher::mark()
              << "\nusage: anticrack-mesher MEMORY_BYTES CPU_SECONDS generate|import\n"
                 "Meshes the one request on its standard input; the server starts it.\n";
    return 2;
  }
  try {
    mesher::restrict_process({*memory, *seconds});
    const mesh::Bytes reply = [&] {
      const stop::Scope scope{stop::Asked(Reporter())};
      return mesh::encode(answer(import, *memory));
    }();
    write_all(STDOUT_FILENO, std::span(&mesher::reply_mark, 1));
    write_all(STDOUT_FILENO, reply);
  } catch (const std::exception& error) {
    std::cerr << "anticrack-mesher: " << error.what() << '\n';
    return 1;
  }
}

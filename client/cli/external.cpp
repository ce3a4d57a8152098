// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/external.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <span>
#include <system_error>

#include "cli/json.hpp"
#include "cli/programs.hpp"
#include "cli/report.hpp"
#include "output/write_all.hpp"

namespace anticrack::cli {
namespace {

namespace fs = std::filesystem;

/// Code for Python; it exits with `missing` if Python lacks the package, or one that this needs.
constexpr const char* bootstrap =
    "import sys\n"
    "try:\n"
    "    from anticrack.commands import main\n"
    "except ModuleNotFoundError:\n"
    "    sys.exit(77)\n"
    "sys.exit(main(sys.argv[1:]))\n";
constexpr int missing = 77;

/// A pipe whose ends are closed in programs that are started.
class Pipe {
 public:
  Pipe() {
    if (pipe2(_ends.data(), O_CLOEXEC) != 0)
      throw FiguresError("no pipe can be made: " + std::generic_category().message(errno));
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_end(0);
    close_end(1);
  }

  int reading() const noexcept { return _ends[0]; }
  int writing() const noexcept { return _ends[1]; }
  void close_end(std::size_t which) noexcept {
    if (_ends[which] >= 0) close(_ends[which]);
    _ends[which] = -1;
  }

 private:
  std::array<int, 2> _ends{-1, -1};
};

std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = read(descriptor, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

std::string interpreter() {
  if (const char* given = std::getenv("ANTICRACK_PYTHON"); given != nullptr && *given != '\0')
    return given;
  constexpr const char* of_debian = "/usr/bin/python3";  // the one of Debian's packages
  return access(of_debian, X_OK) == 0 ? of_debian : find_program("python3").string();
}

/// The environment, in which the package of a build comes before others.
std::vector<std::string> environment() {
  std::vector<std::string> all;
  const fs::path built = this_program().parent_path().parent_path() / "python";
  std::error_code error;
  const bool has_package = fs::exists(built / "anticrack" / "commands.py", error);
  constexpr std::string_view name = "PYTHONPATH=";
  std::string path;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    if (has_package && text.starts_with(name))
      path = text.substr(name.size());
    else
      all.emplace_back(text);
  }
  if (has_package)
    all.push_back(std::string(name) + built.string() + (path.empty() ? "" : ":" + path));
  return all;
}

pid_t start(std::vector<std::string> words, int in, int out) {
  std::vector<std::string> variables = environment();
  int error = 0;
  const int descriptors[] = {in, out};
  const pid_t process = spawn(words, descriptors, pointers_to(variables).data(), 0, error);
  if (error != 0)
    throw FiguresError("cannot start " + words[0] + ": " + std::generic_category().message(error));
  return process;
}

/// The exit code of a process; 128 and more if it died by a signal.
int code_of(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0)
    if (errno != EINTR)
      throw FiguresError("cannot wait for Python: " + std::generic_category().message(errno));
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace

fs::path external_command(const std::string& name) {
  const bool is_name = !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  });
  return is_name && name[0] != '-' ? find_program("anticrack-" + name) : fs::path{};
}

void become(const fs::path& program, std::vector<std::string> words) {
  words.insert(words.begin(), program);
  execv(program.c_str(), pointers_to(words).data());
  throw std::runtime_error("cannot start " + program.string() + ": " +
                           std::generic_category().message(errno));
}

int run_in_python(std::vector<std::string> words, std::string_view input, const Globals& globals,
                  bool with_document) {
  const std::string python = interpreter();
  if (python.empty())
    throw FiguresError(
        "figures and files for ParaView are made in Python, and there is no python3; install "
        "python3-anticrack");
  words.insert(words.begin() + 1, "--json");
  words.insert(words.begin(), {python, "-P", "-c", bootstrap});
  Pipe in, out;
  const pid_t process = start(std::move(words), in.reading(), out.writing());
  in.close_end(0);
  out.close_end(1);
  // The process reads everything before it answers; if it ends earlier, its exit code says so.
  output::write_all(in.writing(), std::as_bytes(std::span(input)));
  in.close_end(1);
  const std::string answer = read_all(out.reading());
  const int code = code_of(process);
  if (code == missing) {
    throw FiguresError(
        "figures and files for ParaView are made by the Python package anticrack, which " + python +
        " lacks, or a package that it takes; install python3-anticrack and "
        "python3-matplotlib, or name another Python in ANTICRACK_PYTHON");
  }
  const Json document = Json::parse(answer, nullptr, false);
  if (!document.is_object())
    throw FiguresError(fmt::format("Python ended with code {} and no answer", code));
  if (with_document && globals.json) {
    print_document(to_text(document));
  } else {
    for (const char* list : {"files", "notes"})
      for (const Json& line : document.value(list, Json::array()))
        say(globals, line.get<std::string>());
  }
  return code;
}

}  // namespace anticrack::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/drawing.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "results/replace_file.hpp"

namespace anticrack::figures {
namespace {

namespace fs = std::filesystem;

struct FileKind {
  const char* extension;
  std::string_view signature;  ///< the first bytes of a file
};

/// By Format.
constexpr std::array<FileKind, 3> kinds{
    {{".png", "\x89PNG\r"}, {".svg", "<?xml"}, {".pdf", "%PDF-"}}};

const FileKind& kind_of(Format format) { return kinds.at(static_cast<std::size_t>(format)); }

/// gnuplot leaves an empty file if it lacks the terminal.
bool has_signature(const fs::path& path, Format format) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 5> head{};
  file.read(head.data(), head.size());
  return file && std::string_view(head.data(), head.size()) == kind_of(format).signature;
}

void shrink(const fs::path& svg) {
  std::ifstream from(svg, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(from), {}};
  std::ofstream to(svg, std::ios::binary | std::ios::trunc);
  to << without_empty_groups(text);
  to.close();
  if (!from || !to) throw Error(svg.string() + ": cannot be written; free space there");
}

/// Temporary files, removed unless renamed.
class Partials {
 public:
  Partials(fs::path folder, const Options& options) : _folder(std::move(folder)) {
    static std::atomic<unsigned> counter{0};
    const std::string stem = ".anticrack-" + std::to_string(getpid()) + "-" +
                             std::to_string(counter.fetch_add(1)) + ".partial";
    for (const Format format : options.formats)
      outputs.push_back({format, stem + kind_of(format).extension, options.dpi, options.titles});
  }
  Partials(const Partials&) = delete;
  Partials& operator=(const Partials&) = delete;
  ~Partials() {
    std::error_code ignored;
    for (const Output& output : outputs) fs::remove(_folder / output.file, ignored);
  }

  void rename_to(const std::string& stem, std::vector<fs::path>& files) {
    for (const Output& output : outputs) {
      const fs::path partial = _folder / output.file;
      if (!has_signature(partial, output.format)) {
        throw Error("gnuplot made no " + std::string(kind_of(output.format).extension) +
                    " file; its package gnuplot-nox may be damaged");
      }
      if (output.format == Format::svg) shrink(partial);
      const fs::path target = _folder / (stem + kind_of(output.format).extension);
      std::error_code error;
      fs::rename(partial, target, error);
      if (error) throw Error(target.string() + ": " + error.message());
      files.push_back(target);
    }
  }

  std::vector<Output> outputs;

 private:
  fs::path _folder;
};

}  // namespace

Drawing::Drawing(fs::path folder, Options options) : _folder(std::move(folder)), _options(options) {
  results::make_folder(_folder);
}

void Drawing::draw(const std::string& stem, const Picture& picture) {
  Partials partials(_folder, _options);
  run_gnuplot(script(picture, partials.outputs), _folder, _options.time_limit);
  partials.rename_to(stem, drawn.files);
}

}  // namespace anticrack::figures

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

#include "figures/gnuplot.hpp"
#include "figures/svg.hpp"
#include "results/replace_file.hpp"

namespace anticrack::figures {
namespace {

namespace fs = std::filesystem;

const char* extension(Format format) {
  switch (format) {
    case Format::png:
      return ".png";
    case Format::svg:
      return ".svg";
    case Format::pdf:
      break;
  }
  return ".pdf";
}

std::string_view signature(Format format) {
  switch (format) {
    case Format::png:
      return "\x89PNG\r";
    case Format::svg:
      return "<?xml";
    case Format::pdf:
      break;
  }
  return "%PDF-";
}

/// gnuplot leaves an empty file where a terminal is missing.
bool has_signature(const fs::path& path, Format format) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 5> head{};
  file.read(head.data(), head.size());
  return file && std::string_view(head.data(), head.size()) == signature(format);
}

void shrink(const fs::path& svg) {
  std::ifstream from(svg, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(from), {}};
  std::ofstream to(svg, std::ios::binary | std::ios::trunc);
  to << without_empty_groups(text);
  to.close();
  if (!from || !to) throw Error(svg.string() + ": cannot be written; free space there");
}

/// Removes its files unless they were renamed.
class Partials {
 public:
  Partials(fs::path folder, const Options& options) : _folder(std::move(folder)) {
    static std::atomic<unsigned> counter{0};
    const std::string stem = ".anticrack-" + std::to_string(getpid()) + "-" +
                             std::to_string(counter.fetch_add(1)) + ".partial";
    for (const Format format : options.formats) {
      outputs.push_back({format, stem + extension(format), options.dpi, options.titles});
    }
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
        throw Error("gnuplot made no " + std::string(extension(output.format)) +
                    " file; its package gnuplot-nox may be damaged");
      }
      if (output.format == Format::svg) shrink(partial);
      const fs::path target = _folder / (stem + extension(output.format));
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

void Drawing::draw(const std::string& stem,
                   const std::function<std::string(const std::vector<Output>&)>& script) {
  Partials partials(_folder, _options);
  run_gnuplot(script(partials.outputs), _folder, _options.time_limit);
  partials.rename_to(stem, drawn.files);
}

}  // namespace anticrack::figures

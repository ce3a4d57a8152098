// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/drawing.hpp"

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "figures/memory_file.hpp"
#include "output/file.hpp"

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

}  // namespace

Drawing::Drawing(fs::path folder, Options options) : _folder(std::move(folder)), _options(options) {
  output::make_folder(_folder);
}

void Drawing::draw(const std::string& stem, const Picture& picture) {
  std::vector<MemoryFile> files(_options.formats.size());
  std::vector<Output> outputs;
  std::vector<int> descriptors;
  for (std::size_t i = 0; i < files.size(); ++i) {
    descriptors.push_back(files[i].descriptor());
    outputs.push_back({_options.formats[i], "/dev/fd/" + std::to_string(descriptors[i]),
                       _options.dpi, _options.titles});
  }
  run_gnuplot(script(picture, outputs), _folder, _options.time_limit, descriptors);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const FileKind& kind = kind_of(outputs[i].format);
    const std::string bytes = files[i].tail();
    if (!bytes.starts_with(kind.signature)) {  // it lacks the terminal
      throw Error("gnuplot made no " + std::string(kind.extension) +
                  " file; its package gnuplot-nox may be damaged");
    }
    const fs::path file = _folder / (stem + kind.extension);
    output::write_file(file,
                       outputs[i].format == Format::svg ? without_empty_groups(bytes) : bytes);
    drawn.files.push_back(file);
  }
}

}  // namespace anticrack::figures

// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/figures.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <fstream>
#include <functional>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "figures/gnuplot.hpp"
#include "figures/script.hpp"
#include "figures/surface.hpp"
#include "figures/svg.hpp"
#include "figures/text.hpp"

namespace anticrack::figures {
namespace {

namespace fs = std::filesystem;
using results::Load;
using results::Result;

/// Triangles drawn at most: more cannot be told apart, and an SVG grows by 200 bytes each.
constexpr std::size_t triangle_limit = 24000;

const char* extension(Format format) {
  return format == Format::png ? ".png" : ".svg";
}

/// gnuplot leaves an empty file where a terminal is missing.
bool has_signature(const fs::path& path, Format format) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 5> head{};
  file.read(head.data(), head.size());
  const std::string_view wanted = format == Format::png ? "\x89PNG\r" : "<?xml";
  return file && std::string_view(head.data(), head.size()) == wanted;
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
    if (options.png) outputs.push_back({Format::png, stem + ".png"});
    if (options.svg) outputs.push_back({Format::svg, stem + ".svg"});
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

class Drawing {
 public:
  Drawing(const fs::path& folder, const Options& options) : _folder(folder), _options(options) {}

  void draw(const std::string& stem,
            const std::function<std::string(const std::vector<Output>&)>& script) {
    Partials partials(_folder, _options);
    run_gnuplot(script(partials.outputs), _folder, _options.time_limit);
    partials.rename_to(stem, drawn.files);
  }

  Drawn drawn;

 private:
  const fs::path& _folder;
  const Options& _options;
};

std::string traces_suffix(std::size_t interface) {
  return interface == 0 ? "-traces" : "-traces-" + std::to_string(interface + 1);
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    throw Error(folder.string() + ": cannot be made a folder" +
                (error ? ": " + error.message() : "") + "; choose another folder with -o");
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw Error(folder.string() + ": " + std::generic_category().message(errno) +
                "; make the folder writable, or choose another one with -o");
  }
}

void draw_load(const Result& result, const Load& load, const std::string& stem, Drawing& drawing) {
  if (load.traces.empty()) {
    drawing.drawn.notes.push_back("load \"" + load.name + "\" has no traces (" +
                                  std::string(results::name(load.status)) + "): nothing to draw");
    return;
  }
  const Surface membrane = load.fields.empty() ? Surface{} : surface(result, load, triangle_limit);
  if (membrane.triangles.empty()) {
    drawing.drawn.notes.push_back(
        "load \"" + load.name + "\": no membrane drawn, the result has no fields; run with fields");
  } else {
    drawing.draw(stem, [&](const auto& outputs) {
      return combined_script(result, load, membrane, outputs);
    });
    drawing.draw(stem + "-membrane", [&](const auto& outputs) {
      return membrane_script(result, load, membrane, outputs);
    });
  }
  for (std::size_t i = 0; i < load.traces.size(); ++i) {
    drawing.draw(stem + traces_suffix(i),
                 [&](const auto& outputs) { return traces_script(result, load, i, outputs); });
  }
  if (has_convergence(load)) {
    drawing.draw(stem + "-convergence",
                 [&](const auto& outputs) { return convergence_script(result, load, outputs); });
  }
}

}  // namespace

Drawn draw(const Result& result, const fs::path& folder, const Options& options) {
  const std::string fault = results::first_fault(result);
  if (!fault.empty()) throw Error("the result is inconsistent: " + fault);
  make_folder(folder);

  std::vector<std::string> names;
  for (const Load& load : result.loads) names.push_back(load.name);
  std::vector<std::string> suffixes{"-membrane", "-convergence"};
  for (std::size_t i = 0; i < result.interfaces.size(); ++i) suffixes.push_back(traces_suffix(i));
  const std::vector<std::string> stems = file_stems(names, suffixes);

  Drawing drawing(folder, options);
  for (std::size_t i = 0; i < result.loads.size(); ++i) {
    draw_load(result, result.loads[i], stems[i], drawing);
  }
  return std::move(drawing.drawn);
}

}  // namespace anticrack::figures

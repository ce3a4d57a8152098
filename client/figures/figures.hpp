// SPDX-License-Identifier: GPL-3.0-or-later
//
// Figures of a result, as Figures 2-5 of Rudoy & Shcherbakov (2016), drawn by gnuplot.
#pragma once

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "results/result.hpp"

namespace anticrack::figures {

/// gnuplot missing, failing or too slow, or a folder that cannot be written.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class Format { png, svg, pdf };

struct Options {
  std::vector<Format> formats{Format::png, Format::svg};  ///< each once
  int dpi = 300;                                          ///< dots an inch of a PNG
  bool titles = true;                                     ///< of case and load, above the panels
  std::chrono::seconds time_limit{120};                   ///< for one picture
  /// Of overview, membrane, plan, traces, convergence and accuracy those to draw of a load; none:
  /// all that have something to show.
  std::vector<std::string> only{};
  /// The only one of the traces, and that of overview and together; empty: the most eventful there,
  /// and traces of all that can open.
  std::string interface {};
  bool all_loads = false;  ///< and rows with traces; else of more than twelve the first
  /// However many can open; else of more than twelve the most eventful alone, unless `only` names
  /// the traces.
  bool all_interfaces = false;
};

struct Drawn {
  std::vector<std::filesystem::path> files;  ///< in the order of the loads
  std::vector<std::string> notes;            ///< what was left out and why
};

/// Draws for every load with traces, in each format, in `folder` (created if missing):
///   LOAD-membrane     the deformed membrane with its slit open; needs fields
///   LOAD-plan         from above: lines of u over the flux; needs fields
///   LOAD-traces       u-, u+ and [u] along each interface that can open, of more than twelve the
///                     most eventful, contact shaded, its pressure below
///   LOAD-convergence  the relative change of every iteration, or the KKT residuals of every step,
///                     log; of at least three, of two where it is asked for
///   LOAD-accuracy     the bounds of the energy and of A over the triangles of the stages
///   LOAD              an overview: membrane left, traces of the most eventful interface right, as
///                     in the paper, and what else there is below, as the pressure where there is
///                     contact; 170 mm wide, all else 85 mm
/// Of a sweep instead:
///   sweep             A and the contact length over the rows, or over the coefficient that varies
///   sweep-contact     where the cracks are closed, row by row (-2, ... of further interfaces)
///   row-K-traces      of the first rows whose traces were kept
/// The notes say what is left out of many loads and interfaces, and what draws it.
/// LOAD is the load's name made safe for a file name, and unique; further interfaces are
/// LOAD-traces-2 and so on. Each file is written under a temporary name and renamed. Throws Error,
/// also for a name that no interface has, for the folder results::Error; files already drawn stay.
Drawn draw(const results::Result& result, const std::filesystem::path& folder,
           const Options& options = {});

/// Draws "together": [u], u-, u+ and the contact pressure of the loads with traces, the first
/// eight, on one interface. Throws as `draw`, and Error where no load has traces.
Drawn draw_together(results::Result result, const std::filesystem::path& folder,
                    const Options& options = {});

}  // namespace anticrack::figures

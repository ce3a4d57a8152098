// SPDX-License-Identifier: GPL-3.0-or-later
#include "estimate/stiff_part.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "errors/errors.hpp"
#include "estimate/continuation.hpp"

namespace anticrack::estimate {
namespace {

/// A part, and the tension of its complement.
struct Candidate {
  double ratio = 0, least = 0, most = 0;
};

/// The least and the largest T of triangles, in any direction.
std::vector<std::array<double, 2>> tensions(const ddm::Decomposition& decomposition,
                                            const CutMesh& cut) {
  std::vector<std::array<double, 2>> found;
  found.reserve(cut.triangle_count());
  for (const ddm::Subdomain& subdomain : decomposition.subdomains) {
    for (std::size_t t = 0; t < subdomain.triangle.size(); ++t) {
      const auto [xx, xy, yy] = subdomain.tension.matrix(t);
      const double mean = (xx + yy) / 2, off = std::hypot((xx - yy) / 2, xy);
      fem::Variation by;
      if (!subdomain.tension.variation.empty()) by = subdomain.tension.variation[t];
      found.push_back({std::max(0.0, mean - off) / (by.below * by.below) * (1 - 1e-9),
                       (mean + off) * by.above * by.above * (1 + 1e-9)});
    }
  }
  return found;
}

}  // namespace

std::optional<StiffPart> stiff_part(const mesh::Mesh& mesh, const ddm::Decomposition& decomposition,
                                    const CutMesh& cut) {
  constexpr std::size_t most_candidates = 3;
  const std::vector<std::array<double, 2>> tension = tensions(decomposition, cut);
  std::vector<std::array<double, 2>> sorted = tension;
  std::ranges::sort(sorted);
  std::vector<Candidate> candidates;
  double most = 0;
  for (std::size_t k = 0; k + 1 < sorted.size(); ++k) {
    most = std::max(most, sorted[k][1]);
    const double least = sorted[k + 1][0];
    if (least >= least_contrast * most) candidates.push_back({least / most, least, most});
  }
  std::ranges::stable_sort(candidates, std::ranges::greater{}, &Candidate::ratio);
  if (candidates.empty()) return std::nullopt;
  for (const Candidate& one :
       std::span(candidates).first(std::min(candidates.size(), most_candidates))) {
    StiffPart part;
    for (const auto& of : tension) part.has.push_back(of[0] >= one.least ? 1 : 0);
    try {
      part.continuation = continuation(mesh, cut, part.has);
    } catch (const errors::Error& error) {
      if (error.reason() != errors::Reason::numerical) throw;
      continue;  // contact alone holds a piece
    }
    if (!(part.continuation >= 0)) continue;
    part.coupling = part.continuation * std::sqrt(one.most / one.least);
    return part;
  }
  return std::nullopt;
}

}  // namespace anticrack::estimate

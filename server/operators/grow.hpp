// SPDX-License-Identifier: GPL-3.0-or-later
//
// Growth of cracks and delaminations under one load, on one mesh.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "growth/evolution.hpp"
#include "growth/fronts.hpp"
#include "operators/mesh_operator.hpp"

namespace anticrack::contact {
struct Field;
struct TipAnswer;
}  // namespace anticrack::contact

namespace anticrack::operators {

/// Numbers of the fronts of some paths, wherever these are (growth/preview.hpp). Keeps the
/// operators of the mesh alive. For one thread.
class Growth {
 public:
  /// `dead`: a load that acts besides and is not scaled. Throws errors::Error: as growth::Preview;
  /// internal for a load of another mesh or a combination.
  Growth(std::shared_ptr<const MeshOperator> mesh_operator, PreparedLoad load,
         std::span<const growth::Path> paths, const std::stop_token& stop = {},
         std::optional<PreparedLoad> dead = {});
  ~Growth();
  Growth(const Growth&) = delete;
  Growth& operator=(const Growth&) = delete;

  std::vector<growth::Track> tracks() const;
  const growth::Fronts& fronts() const noexcept;
  /// As growth::Preview::fields.
  std::vector<contact::Field> fields(const growth::State& state, double t,
                                     const std::stop_token& stop = {});
  /// As growth::Preview::ends.
  std::vector<contact::TipAnswer> ends(const std::stop_token& stop = {});
  /// As growth::Preview::answer.
  contact::Answer answer(const growth::State& state, const contact::ActiveSetOptions& options,
                         contact::Observer& observer);
  /// As growth::Preview::measure.
  growth::Measured measure(const growth::State& state, const std::stop_token& stop = {});
  growth::Measured measure(const growth::State& state, const growth::Sought& sought,
                           const std::stop_token& stop = {});

 private:
  struct Parts;
  std::unique_ptr<Parts> _parts;
};

}  // namespace anticrack::operators

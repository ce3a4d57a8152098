// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>
#include <utility>

#include "figures/panels.hpp"

namespace anticrack::figures {
namespace {

/// Without what the panel before has set.
const std::string fresh = "reset\nset encoding utf8\nset minussign\n";

/// What there is beside the plan.
std::optional<Picture> beside_plan(const results::Result& result, const results::Load& load,
                                   const TracesPanels& traces) {
  if (traces.in_contact) {
    return Picture{traces.pressure_data,
                   {},
                   [=](Format, const Place& place) {
                     const std::string on = traces.name.empty() ? "" : " on " + traces.name;
                     return caption("contact pressure" + on, place) +
                            traces.axis_label(0.13, place) + traces.pressure(place, {0.21, 0.885});
                   },
                   narrow};
  }
  if (bounded_stages(load) > 1) return errors_picture(result, load);
  if (has_convergence(load)) return convergence_picture(result, load);
  return std::nullopt;
}

}  // namespace

Picture overview_picture(const results::Result& result, const results::Load& load,
                         const Surface& surface, const Eventful& interfaces) {
  const Picture membrane = membrane_picture(result, load, surface);
  const TracesPanels traces = traces_panels(result, load, interfaces.open);
  const auto upper = [=, left = membrane.plots](Format format, const Place& place) {
    const auto [left_half, right_half] = halves(place);
    return left(format, left_half) + traces.axis_label(0.2, right_half) +
           traces.displacements(right_half, {0.305, 0.905});
  };
  std::string data = membrane.data + traces.data;
  const auto other = beside_plan(result, load, traces_panels(result, load, interfaces.pressed));
  if (!other) return {data, membrane.title, upper, page};
  const Picture plan = plan_picture(result, load, surface);
  const Canvas both{page.width, page.height + square.height};
  return {data + plan.data + other->data, membrane.title,
          [=, left = plan.plots, right = other->plots](Format format, const Place& place) {
            const double part = place.height * square.height / both.height;
            const auto [left_half, right_half] = halves({place.x, place.y, place.width, part});
            return upper(format, {place.x, place.y + part, place.width, place.height - part}) +
                   fresh + left(format, left_half) + fresh + right(format, right_half);
          },
          both};
}

}  // namespace anticrack::figures

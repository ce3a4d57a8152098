// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/accuracy.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "errors/errors.hpp"
#include "records/case_record.hpp"

namespace anticrack::jobs {

namespace {

using errors::Error;
using errors::Reason;

/// Below this accuracy, the smallest triangles at a tip leave a larger error.
constexpr double finest = 1e-6;
constexpr double coarsest = 1;

/// Limited because the job's record has their answers once for each stage.
constexpr std::size_t most_loads = 256;
constexpr std::size_t most_stages = 40;

/// After this many stages without a smaller error, there is no hope.
constexpr std::size_t patience = 3;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Cap of an error relative to a value that is 0 up to rounding: no stage makes it smaller.
constexpr double of_zero = 1e6;

void check_tolerance(const std::optional<double>& value, const char* field) {
  if (!value || (*value >= finest && *value <= coarsest)) return;
  throw Error(Reason::invalid_argument,
              "{:g} is not an accuracy: give a relative error from 1e-6 to 1", *value)
      .at(field);
}

/// The load case with the largest excess.
struct Worst {
  std::size_t load = 0;
  double excess = 0;
};
Worst worst_of(const records::StageRecord& stage, const records::AccuracySpec& wanted) {
  Worst worst;
  for (std::size_t i = 0; i < stage.answers.size(); ++i)
    if (const double one = excess(stage.answers[i], wanted); one > worst.excess) worst = {i, one};
  return worst;
}

/// Whether any load case that has not reached the accuracy is now clearly nearer to it than in all
/// stages before the last few (`patience`).
bool improves(const std::vector<records::StageRecord>& stages,
              const records::AccuracySpec& wanted) {
  for (std::size_t i = 0; i < stages.back().answers.size(); ++i) {
    const double now = excess(stages.back().answers[i], wanted);
    double before = infinity;
    for (std::size_t k = 0; k + patience < stages.size(); ++k)
      before = std::min(before, excess(stages[k].answers[i], wanted));
    if (now > 1 && now <= 0.9 * before) return true;
  }
  return false;
}

/// The reason why a load case has no bounds; empty if it has them.
std::string why_unbounded(const records::CaseRecord& one) {
  if (one.error) return one.error->what();
  return one.status == contact::Status::converged ? one.answer.no_bracket : one.answer.reason;
}

double relative_width(const records::StageAnswer& answer) {
  const double width = *answer.energy_upper - *answer.energy_lower;
  return width > 0 ? width / std::abs(answer.energy) : 0;
}

/// An error as text, in the format of the client.
std::string in_per_cent(double error, double asked, const std::optional<double>& scale = {}) {
  const std::string of = scale ? fmt::format(" of {:.2g}", *scale) : "";
  return fmt::format("{:.3g} %{} (asked {:g} %)", 100 * error, of, 100 * asked);
}

/// A value whose bounds may have 0 between them, so that an error relative to it means nothing.
struct AroundZero {
  std::string name;               ///< the name by which users ask for it
  double within = -1;             ///< the largest amount it may have; negative if it is not 0
  std::optional<double> scale{};  ///< what its error is relative to, instead of itself

  explicit operator bool() const { return within >= 0; }
  void add(const std::optional<double>& lower, const std::optional<double>& upper) {
    if (lower && upper && *lower <= 0 && *upper >= 0) within = std::max({within, -*lower, *upper});
  }
};

AroundZero energy_around_zero(const records::StageAnswer& answer,
                              const records::AccuracySpec& wanted) {
  AroundZero found{"energy"};
  if (wanted.energy && relative_width(answer) > *wanted.energy)
    found.add(answer.energy_lower, answer.energy_upper);
  return found;
}

/// The A of a load case with the largest error.
struct WorstA {
  const contact::InclusionAnswer* inclusion;
  double size;   ///< to which its error is relative, unless 0 is nearer
  double error;  ///< contact::error_of or contact::probable_error_of it
};

/// Returns none if there is no inclusion, or one without bounds.
std::optional<WorstA> worst_a(const contact::AnswerSummary& answer, bool of_largest,
                              double (*error_of)(const contact::InclusionAnswer&, double)) {
  double largest = 0;
  for (const contact::InclusionAnswer& one : answer.inclusions) {
    if (!one.displacement_lower || !one.displacement_upper) return std::nullopt;
    largest = std::max(largest, std::abs(one.displacement));
  }
  std::optional<WorstA> worst;
  for (const contact::InclusionAnswer& one : answer.inclusions) {
    const double size = of_largest ? largest : std::abs(one.displacement),
                 error = error_of(one, size);
    if (!worst || error > worst->error) worst = {&one, size, error};
  }
  return worst;
}

/// The A of the largest error.
AroundZero displacement_around_zero(const contact::AnswerSummary& answer,
                                    const records::AccuracySpec& wanted) {
  AroundZero found{"A"};
  if (!wanted.displacement) return found;
  const std::optional<WorstA> worst = worst_a(answer, wanted.largest, contact::error_of);
  if (!worst || !(worst->error > *wanted.displacement)) return found;
  const contact::InclusionAnswer& one = *worst->inclusion;
  const double half = 0.5 * (*one.displacement_upper - *one.displacement_lower);
  found.add(one.displacement_lower, one.displacement_upper);
  if (worst->error < half / worst->size) found.scale = one.displacement_scale;
  if (!found.scale && worst->size > found.within) found.within = -1;
  if (answer.inclusions.size() > 1) found.name = "A of \"" + one.name + "\"";
  return found;
}

/// What was reached of a value with this relative error.
std::string reached(const AroundZero& value, double error, double asked) {
  if (!value) return value.name + " " + in_per_cent(error, asked, value.scale);
  return fmt::format("{} is 0 within {:.2g}", value.name, value.within) +
         (value.scale ? ", " + in_per_cent(error, asked, value.scale) : "");
}

/// The reason why no further stage helps.
std::string no_hope(const records::StageAnswer& answer, const contact::AnswerSummary& summary,
                    const records::AccuracySpec& wanted) {
  if (const AroundZero of_a = displacement_around_zero(summary, wanted); of_a && !of_a.scale) {
    const bool others = summary.inclusions.size() > 1 && !wanted.largest;
    return fmt::format("an error relative to 0 cannot be reached; {}ask for accuracy.energy",
                       others ? "set accuracy.largest, or " : "");
  }
  if (energy_around_zero(answer, wanted))
    return "an error relative to 0 cannot be reached; ask for accuracy.A";
  return "finer meshes no longer help: rounding, a tip_size too large for it, or, of A, cracks "
         "that cross or more than 16 inclusions";
}

/// The rate at which an error fell between two stages, as triangles^-rate; 0 if it did not, or if
/// one of the errors is unknown or so large that it says nothing yet.
double rate_between(double error_before, const records::StageRecord& before, double error,
                    const records::StageRecord& now) {
  constexpr double least = 0.1;
  const double fell = std::log(error_before / error),
               grew = std::log(static_cast<double>(now.triangles) /
                               static_cast<double>(before.triangles));
  return error_before < 1 && grew > 0 && fell > least * grew ? fell / grew : 0;
}

/// What to do if the estimate of chords keeps an accuracy from being reached, as soon as the error
/// is below it, or all of the accuracy that may be left; empty if it does not. What chords change
/// falls as the third power of their angle.
std::string too_coarse(const records::StageRecord& stage, const records::AccuracySpec& wanted,
                       double chord_angle) {
  constexpr double part = 0.2;  // of the accuracy, for the new chords
  std::string found;
  double most = 0;
  const auto consider = [&](const char* name, const std::optional<double>& asked, auto error_of,
                            std::optional<double> records::StageAnswer::*of_chords) {
    for (const records::StageAnswer& answer : stage.answers) {
      const double gap = (answer.*of_chords).value_or(0);
      if (!asked || gap <= *asked / 2 || gap <= most * *asked) continue;
      const double error = error_of(answer);
      if (error + gap <= *asked || error > (gap < *asked ? *asked / 2 : gap)) continue;
      most = gap / *asked;
      found = fmt::format("{} by about {:.2g} %", name, 100 * gap);
    }
  };
  using Answer = records::StageAnswer;
  consider("energy", wanted.energy, relative_width, &Answer::energy_geometry_error);
  consider(
      "A", wanted.displacement,
      [](const Answer& answer) { return answer.displacement_error.value_or(infinity); },
      &Answer::displacement_geometry_error);
  consider(
      "A", wanted.displacement_estimated,
      [](const Answer& answer) { return answer.displacement_error_probable.value_or(infinity); },
      &Answer::displacement_geometry_error);
  if (most == 0) return "";
  return fmt::format(
      "curves in place of their chords of {:g} degrees may change {}: set mesh.chord_angle = "
      "{:.2g}",
      chord_angle, found, chord_angle * std::cbrt(part / most));
}

/// What a proof needs, if its error goes on to fall at this rate.
struct Need {
  const char* name = "";
  double asked = 1, error = 0, rate = 0;
  double at = 0;  ///< triangles of the stage with this error

  double triangles() const {
    return rate > 0 && error > asked ? at * std::pow(error / asked, 1 / rate) : 0;
  }
};

}  // namespace

void check_accuracy(const records::JobSpec& spec) {
  const records::AccuracySpec& wanted = *spec.accuracy;
  if (!wanted.energy && !wanted.displacement && !wanted.displacement_estimated) {
    throw Error(
        Reason::invalid_argument,
        "no accuracy is asked for: give energy = 1e-3, A = 1e-3 (displacement), or both; or "
        "A_estimated = 1e-3 (displacement_estimated), without a proof")
        .at("accuracy");
  }
  if (wanted.largest && !wanted.displacement && !wanted.displacement_estimated) {
    throw Error(Reason::invalid_argument, "is about A (displacement): give that with it")
        .at("accuracy.largest");
  }
  check_tolerance(wanted.energy, "accuracy.energy");
  check_tolerance(wanted.displacement, "accuracy.displacement");
  check_tolerance(wanted.displacement_estimated, "accuracy.displacement_estimated");
  if (!std::holds_alternative<contact::ActiveSetOptions>(spec.solver)) {
    throw Error(Reason::invalid_argument,
                "an accuracy needs bounds, which Algorithm 2 (uzawa) does not have: use the active "
                "set")
        .at("solver.uzawa");
  }
  if (spec.without_bounds) {
    throw Error(Reason::invalid_argument, "an accuracy needs bounds: leave one of the two out")
        .at("without_bounds");
  }
  if (spec.loads.size() > most_loads) {
    throw Error(Reason::limit_exceeded,
                "{} load cases: a job with an accuracy has at most {}; make several "
                "jobs",
                spec.loads.size(), most_loads)
        .at("load_cases");
  }
  for (std::size_t i = 0; i < spec.loads.size(); ++i) {
    if (!std::holds_alternative<fem::Array>(spec.loads[i].force)) continue;
    throw Error(Reason::invalid_argument,
                "an array belongs to one mesh, and a job with an accuracy has several: give f as "
                "an expression")
        .at(fmt::format("load_cases[{}].force", i));
  }
}

void tighten(records::CaseRecord& answer, const records::CaseRecord& before) {
  using Bound = std::optional<double>;
  const auto closer = [](Bound& lower, Bound& upper, const Bound& other_lower,
                         const Bound& other_upper) {
    if (!other_lower || !other_upper) return;
    const double low = lower ? std::max(*lower, *other_lower) : *other_lower;
    const double high = upper ? std::min(*upper, *other_upper) : *other_upper;
    if (low > high) return;  // only by rounding
    lower = low;
    upper = high;
  };
  if (!answer.answer.energy_lower) return;  // no_bracket says why it has no bounds
  closer(answer.answer.energy_lower, answer.answer.energy_upper, before.answer.energy_lower,
         before.answer.energy_upper);
  const std::size_t both =
      std::min(answer.answer.inclusions.size(), before.answer.inclusions.size());
  for (std::size_t j = 0; j < both; ++j) {
    contact::InclusionAnswer& one = answer.answer.inclusions[j];
    const contact::InclusionAnswer& other = before.answer.inclusions[j];
    closer(one.displacement_lower, one.displacement_upper, other.displacement_lower,
           other.displacement_upper);
    closer(one.slope_x_lower, one.slope_x_upper, other.slope_x_lower, other.slope_x_upper);
    closer(one.slope_y_lower, one.slope_y_upper, other.slope_y_lower, other.slope_y_upper);
  }
  contact::take_middles(answer.answer);
}

records::StageAnswer stage_answer(const records::CaseRecord& ended_case, bool largest) {
  const contact::AnswerSummary& answer = ended_case.answer;
  records::StageAnswer result{answer.energy, answer.energy_lower, answer.energy_upper,
                              answer.error_bound_relative};
  if (answer.energy_geometry_error && answer.energy != 0)
    result.energy_geometry_error = *answer.energy_geometry_error / std::abs(answer.energy);
  if (const auto worst = worst_a(answer, largest, contact::error_of)) {
    result.displacement_error = worst->error;
    if (answer.energy_geometry_error)
      result.displacement_geometry_error =
          worst_a(answer, largest, contact::geometry_error_of)->error;
  }
  const bool all_estimated =
      std::ranges::all_of(answer.inclusions, [](const contact::InclusionAnswer& one) {
        return one.displacement_error_probable.has_value();
      });
  if (!all_estimated) return result;
  if (const auto worst = worst_a(answer, largest, contact::probable_error_of))
    result.displacement_error_probable = worst->error;
  return result;
}

double excess(const records::StageAnswer& answer, const records::AccuracySpec& wanted) {
  double result = 0;
  const auto add = [&](double error, double asked, const std::optional<double>& of_chords) {
    const double left = std::max(asked - of_chords.value_or(0), asked / 2);
    result = std::max(result, std::min(error, of_zero) / left);
  };
  if (wanted.energy) {
    if (!answer.energy_lower || !answer.energy_upper) return infinity;
    add(relative_width(answer), *wanted.energy, answer.energy_geometry_error);
  }
  if (wanted.displacement) {
    if (!answer.displacement_error) return infinity;
    add(*answer.displacement_error, *wanted.displacement, answer.displacement_geometry_error);
  }
  if (wanted.displacement_estimated) {
    if (!answer.displacement_error_probable) return infinity;
    add(*answer.displacement_error_probable, *wanted.displacement_estimated,
        answer.displacement_geometry_error);
  }
  return result;
}

double rate_of(const std::vector<records::StageRecord>& stages,
               const records::AccuracySpec& wanted) {
  constexpr double clearly_less = 0.8, least = 0.5;
  if (stages.size() < 2) return 1;
  const records::StageRecord &now = stages.back(), &before = stages[stages.size() - 2];
  const double fell = std::log(worst_of(before, wanted).excess / worst_of(now, wanted).excess),
               grew = std::log(static_cast<double>(now.triangles) /
                               static_cast<double>(before.triangles));
  if (!(grew > 0) || !std::isfinite(fell) || !(fell < clearly_less * grew)) return 1;
  return std::max(least, fell / grew);
}

std::string not_reached(const records::StageRecord& last,
                        std::span<const records::CaseRecord* const> cases,
                        const records::JobSpec& spec, const std::string& why) {
  const records::AccuracySpec& wanted = *spec.accuracy;
  const std::size_t load = worst_of(last, wanted).load;
  const records::StageAnswer& answer = last.answers[load];
  std::string found;
  const auto add = [&](const AroundZero& value, double error, double asked) {
    found += (found.empty() ? "" : ", ") + reached(value, error, asked);
  };
  if (wanted.energy && answer.energy_lower)
    add(energy_around_zero(answer, wanted), relative_width(answer), *wanted.energy);
  if (wanted.displacement && answer.displacement_error) {
    add(cases.empty() ? AroundZero{"A"} : displacement_around_zero(cases[load]->answer, wanted),
        *answer.displacement_error, *wanted.displacement);
  }
  if (wanted.displacement_estimated && answer.displacement_error_probable)
    add({"A by estimate"}, *answer.displacement_error_probable, *wanted.displacement_estimated);
  return fmt::format("load case \"{}\" reached {} on {} triangles: {}", spec.loads[load].name,
                     found.empty() ? "no bounds" : found, last.triangles, why);
}

std::string forecast(const std::vector<records::StageRecord>& stages, const records::JobSpec& spec,
                     std::uint64_t max_triangles) {
  constexpr std::uint64_t apart = 4;  // rates of stages of about the same size mean little
  const records::StageRecord& now = stages.back();
  const auto found = std::find_if(stages.rbegin(), stages.rend(), [&](const auto& stage) {
    return apart * stage.triangles <= now.triangles;
  });
  if (found == stages.rend()) return "";
  const records::StageRecord& before = *found;
  const records::AccuracySpec& wanted = *spec.accuracy;
  Need most;
  const auto consider = [&](const char* name, const std::optional<double>& asked, auto error_of) {
    for (std::size_t i = 0; asked && i < now.answers.size(); ++i) {
      const double error = error_of(now.answers[i]);
      const Need need{name, *asked, error,
                      rate_between(error_of(before.answers[i]), before, error, now),
                      static_cast<double>(now.triangles)};
      if (need.triangles() > most.triangles()) most = need;
    }
  };
  consider("energy", wanted.energy, [](const records::StageAnswer& answer) {
    return answer.energy_lower && answer.energy_upper ? relative_width(answer) : infinity;
  });
  consider("A", wanted.displacement, [](const records::StageAnswer& answer) {
    return answer.displacement_error.value_or(infinity);
  });
  const auto limit = static_cast<double>(max_triangles);
  if (!(most.triangles() > limit)) return "";
  return fmt::format(
      "{} to {:g} % needs about {:.2g} triangles; the limit is {}, where about {:.2g} % can be "
      "proved "
      "(the error falls as triangles^-{:.2f})",
      most.name, 100 * most.asked, most.triangles(), max_triangles,
      100 * most.error * std::pow(most.at / limit, most.rate), most.rate);
}

std::string limit_reached(const records::JobSpec& spec, std::uint64_t max_triangles) {
  const bool own = max_triangles == spec.accuracy->max_triangles;
  return fmt::format("a finer mesh has more than {} triangles, {}", max_triangles,
                     own ? "max_triangles of the accuracy; raise it"
                         : "mesh-triangles of the server; ask for a larger error, or start the "
                           "server with more");
}

Verdict judge(const std::vector<records::StageRecord>& stages,
              const std::vector<const records::CaseRecord*>& cases, const records::JobSpec& spec,
              std::uint64_t max_triangles, double seconds, double chord_angle) {
  const records::AccuracySpec& wanted = *spec.accuracy;
  const records::StageRecord& last = stages.back();
  const auto stop = [&](const std::string& why) {
    return Verdict{true, not_reached(last, cases, spec, why)};
  };
  for (const records::CaseRecord* one : cases) {
    const std::string why = why_unbounded(*one);
    if (why.empty()) continue;
    if (stages.size() > 1) {
      return {true,
              not_reached(stages[stages.size() - 2], {}, spec,
                          fmt::format("on {} there are no bounds: {}", last.triangles, why)),
              true};
    }
    return one->status == contact::Status::converged ? stop(why) : Verdict{true, ""};
  }
  const Worst worst = worst_of(last, wanted);
  if (const std::string chords = too_coarse(last, wanted, chord_angle); !chords.empty())
    return stop(chords);
  if (worst.excess <= 1) return {true, ""};
  if ((wanted.displacement || wanted.displacement_estimated) &&
      !last.answers[worst.load].displacement_error) {
    return stop(cases[worst.load]->answer.inclusions.empty()
                    ? "the mesh has no inclusion; ask for an accuracy of the energy"
                    : "there are no bounds of A on this mesh (too many inclusions and triangles, "
                      "or a part that only contact holds); ask for an accuracy of the energy");
  }
  if (wanted.displacement_estimated && !last.answers[worst.load].displacement_error_probable)
    return stop("there is no estimate of the error of A on this mesh; ask for accuracy.A instead");
  if (last.triangles >= max_triangles) return stop(limit_reached(spec, max_triangles));
  if (spec.accuracy->time.count() > 0 &&
      seconds >= std::chrono::duration<double>(spec.accuracy->time).count())
    return stop("the time for it is over; raise accuracy.time");
  if (stages.size() >= most_stages)
    return stop("a job has at most 40 stages; start from a finer mesh");
  if (!improves(stages, wanted))
    return stop(no_hope(last.answers[worst.load], cases[worst.load]->answer, wanted));
  return {};
}

}  // namespace anticrack::jobs

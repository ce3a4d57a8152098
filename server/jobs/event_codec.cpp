// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/event_codec.hpp"

#include <algorithm>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "anticrack/v1/solve.pb.h"
#include "api/translations.hpp"
#include "contact/answer.hpp"
#include "contact/sweep_columns.hpp"
#include "jobs/ended_logs.hpp"
#include "records/case_record.hpp"
#include "records/job_record.hpp"

namespace anticrack::jobs {

namespace {

using v1::WatchJobResponse;

bool is_sample(const NumberedEvent& event) {
  return std::holds_alternative<SampleEvent>(event.event);
}

/// Adds the samples of a run that are kept.
void write(std::span<const NumberedEvent> run, v1::Samples& to) {
  std::unordered_map<std::int32_t, std::size_t> count, seen;
  for (const NumberedEvent& one : run) ++count[std::get<SampleEvent>(one.event).load_case];
  for (const NumberedEvent& one : run) {
    const auto& [load_case, sample] = std::get<SampleEvent>(one.event);
    const std::size_t all = count[load_case], step = (all + samples_a_row - 1) / samples_a_row;
    if (const std::size_t place = ++seen[load_case]; place % step != 0 && place != all) continue;
    to.add_load_case(load_case);
    to.add_iteration(sample.iteration);
    to.add_criterion(sample.criterion);
    to.add_energy(sample.energy);
    to.add_contact_count(sample.contact_count);
    to.add_kkt_gap(sample.kkt.gap);
    to.add_kkt_sign(sample.kkt.sign);
    to.add_kkt_complementarity(sample.kkt.complementarity);
    to.add_kkt_equilibrium(sample.kkt.equilibrium);
  }
}

void write(const CaseEvent& ended, WatchJobResponse& to) {
  v1::LoadCaseEnded& load_case = *to.add_load_cases_ended();
  load_case.set_load_case(ended.load_case);
  *load_case.mutable_answer() = api::message(*ended.record);
}

/// Whether it can be the body of a row with this last number.
bool is_whole(const WatchJobResponse& body, std::uint64_t last) {
  const v1::Samples& of = body.samples();
  for (const int count : {of.iteration_size(), of.criterion_size(), of.energy_size(),
                          of.contact_count_size(), of.kkt_gap_size(), of.kkt_sign_size(),
                          of.kkt_complementarity_size(), of.kkt_equilibrium_size()})
    if (count != of.load_case_size()) return false;
  return body.sequence() > 0 && body.sequence() <= last &&
         (body.has_samples() || body.has_phase() || body.has_sweep_rows() ||
          body.has_stage_ended() || body.has_growth_step() || body.load_cases_ended_size() == 1);
}

std::vector<SampleEvent> read_samples(const v1::Samples& from) {
  std::vector<SampleEvent> samples(static_cast<std::size_t>(from.load_case_size()));
  for (int i = 0; i < from.load_case_size(); ++i) {
    auto& [load_case, sample] = samples[static_cast<std::size_t>(i)];
    load_case = from.load_case(i);
    sample.iteration = from.iteration(i);
    sample.criterion = from.criterion(i);
    sample.energy = from.energy(i);
    sample.contact_count = from.contact_count(i);
    sample.kkt = {from.kkt_equilibrium(i), from.kkt_gap(i), from.kkt_sign(i),
                  from.kkt_complementarity(i)};
  }
  return samples;
}

RowsEvent read_rows(const v1::SweepRows& from) {
  const auto rows = static_cast<std::size_t>(from.status_size());
  const auto inclusions = rows == 0 ? 0 : static_cast<std::size_t>(from.displacement_size()) / rows;
  auto columns = std::make_shared<contact::SweepColumns>(rows, inclusions, 0);
  for (std::size_t row = 0; row < rows; ++row)
    columns->status[row] = static_cast<contact::Status>(from.status(static_cast<int>(row)));
  columns->steps.assign(from.steps().begin(), from.steps().end());
  columns->energy.assign(from.energy().begin(), from.energy().end());
  columns->contact_length.assign(from.contact_length().begin(), from.contact_length().end());
  columns->kkt.assign(from.kkt().begin(), from.kkt().end());
  columns->displacement.assign(from.displacement().begin(), from.displacement().end());
  columns->slope.assign(from.slope().begin(), from.slope().end());
  return {from.first_row(), std::move(columns)};
}

Event read_event(const WatchJobResponse& from) {
  switch (from.event_case()) {
    case WatchJobResponse::kPhase:
      return PhaseEvent{static_cast<records::JobState>(from.phase().state()),
                        from.phase().detail()};
    case WatchJobResponse::kSweepRows:
      return read_rows(from.sweep_rows());
    case WatchJobResponse::kStageEnded:
      return StageEvent{std::make_shared<const records::StageRecord>(
          api::Translation<records::StageRecord>::read(from.stage_ended()))};
    case WatchJobResponse::kGrowthStep: {
      auto growth = std::make_shared<contact::GrowthRow>();
      api::read_fields(from.growth_step().row(), *growth);
      return GrowthEvent{from.growth_step().load_case(), from.growth_step().number(),
                         std::move(growth)};
    }
    default:
      return CaseEvent{
          from.load_cases_ended(0).load_case(),
          std::make_shared<const records::CaseRecord>(
              api::Translation<records::CaseRecord>::read(from.load_cases_ended(0).answer()))};
  }
}

}  // namespace

void write(const PhaseEvent& phase, WatchJobResponse& to) {
  to.mutable_phase()->set_state(static_cast<v1::JobStatus::State>(phase.state));
  to.mutable_phase()->set_detail(api::utf8(phase.detail));
}

void write(const RowsEvent& event, WatchJobResponse& to) {
  const contact::SweepColumns& from = *event.rows;
  v1::SweepRows& rows = *to.mutable_sweep_rows();
  rows.set_first_row(event.first_row);
  for (const contact::Status status : from.status)
    rows.add_status(static_cast<std::int32_t>(status));
  *rows.mutable_steps() = {from.steps.begin(), from.steps.end()};
  *rows.mutable_energy() = {from.energy.begin(), from.energy.end()};
  *rows.mutable_contact_length() = {from.contact_length.begin(), from.contact_length.end()};
  *rows.mutable_kkt() = {from.kkt.begin(), from.kkt.end()};
  *rows.mutable_displacement() = {from.displacement.begin(), from.displacement.end()};
  *rows.mutable_slope() = {from.slope.begin(), from.slope.end()};
}

void write(const StageEvent& event, WatchJobResponse& to) {
  *to.mutable_stage_ended() = api::message(*event.stage);
}

void write(const GrowthEvent& event, WatchJobResponse& to) {
  v1::GrowthStep& step = *to.mutable_growth_step();
  step.set_load_case(event.load_case);
  step.set_number(event.number);
  api::write_fields(*event.row, *step.mutable_row());
}

std::vector<store::EventRow> pack(const std::string& job, int attempt,
                                  std::span<const NumberedEvent> events) {
  std::vector<store::EventRow> rows;
  while (!events.empty()) {
    const auto end = std::find_if_not(events.begin(), events.end(), is_sample);
    const auto samples = static_cast<std::size_t>(end - events.begin());
    const std::size_t taken = std::max<std::size_t>(1, samples);
    WatchJobResponse body;
    if (samples > 0)
      write(events.first(samples), *body.mutable_samples());
    else
      std::visit(
          [&]<class Kind>(const Kind& kind) {
            if constexpr (!std::is_same_v<Kind, SampleEvent> && !std::is_same_v<Kind, EndEvent>)
              write(kind, body);
          },
          events.front().event);
    body.set_sequence(events.front().sequence);
    rows.push_back({job, attempt, events[taken - 1].sequence, api::serialized(body)});
    events = events.subspan(taken);
  }
  return rows;
}

void unpack(const store::EventRow& row, EventLog& log) {
  WatchJobResponse body;
  if (!body.ParseFromString(row.body) || !is_whole(body, row.last)) return log.lose(row.last);
  log.jump(sequence_base(static_cast<int>((body.sequence() - 1) >> 40U) + 1));
  log.lose(body.sequence() - 1);
  if (body.has_samples()) {
    log.jump(row.last - static_cast<std::uint64_t>(body.samples().load_case_size()));
    log.append(read_samples(body.samples()));
  } else {
    log.jump(row.last - 1);
    log.append(read_event(body));
  }
}

}  // namespace anticrack::jobs

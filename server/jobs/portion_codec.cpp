// SPDX-License-Identifier: GPL-3.0-or-later
#include "jobs/portion_codec.hpp"

#include <algorithm>
#include <span>

#include "api/translations.hpp"
#include "contact/sweep_columns.hpp"
#include "jobs/sweep_result.hpp"
#include "store/records.pb.h"

namespace anticrack::jobs {

namespace {

std::string read(const store::Spool& spool, const store::Spool::Run& run) {
  std::string bytes(run.bytes, '\0');
  spool.read(run.place, std::as_writable_bytes(std::span(bytes)));
  return bytes;
}

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

errors::Error damaged() {
  return {errors::Reason::storage, "a position is damaged in the database: submit the job again"};
}

template <class Message, class Value>
std::string packed(const Value& value) {
  Message to;
  api::write_fields(value, to);
  return api::serialized(to);
}

template <class Message, class Value>
Value unpacked(const std::string& bytes) {
  Message from;
  if (!from.ParseFromString(bytes)) throw damaged();
  Value value;
  api::read_fields(from, value);
  return value;
}

}  // namespace

std::string pack(const std::vector<std::pair<SweepChunk, records::SweepRecord>>& chunks,
                 const store::Spool& spool) {
  store::disk::SolvedPortion body;
  for (const auto& [chunk, sums] : chunks) {
    store::disk::SolvedChunk& to = *body.add_chunks();
    api::write_field(sums, to, "answer");
    to.set_columns(read(spool, *chunk.columns));
    if (!chunk.traces) continue;
    api::write_field(chunk.traces->arrays, to, "trace_arrays");
    to.set_traces(read(spool, chunk.traces->run));
  }
  return api::serialized(body);
}

std::vector<EndedChunk> unpack(const store::SolvedPortion& portion, const JobPtr& job) {
  const SweepPlan& plan = job->sweep->plan;
  const std::size_t first = portion.number * plan.portion_chunks;
  store::disk::SolvedPortion body;
  if (!body.ParseFromString(portion.body) || first >= plan.chunks() ||
      static_cast<std::size_t>(body.chunks_size()) !=
          std::min(plan.portion_chunks, plan.chunks() - first))
    throw errors::Error(errors::Reason::storage,
                        "portion {} of jobs/{} is damaged in the database: submit the job again",
                        portion.number, job->id());
  std::vector<EndedChunk> chunks;
  for (const store::disk::SolvedChunk& from : body.chunks()) {
    const std::size_t index = first + chunks.size();
    EndedChunk chunk{{job, index, {}}};
    chunk.fetched = true;
    auto columns =
        std::make_shared<contact::SweepColumns>(unsolved_rows(*job, plan.rows_in(index)));
    read_columns(bytes_of(from.columns()), *columns);
    chunk.columns = std::move(columns);
    api::read_field(from, "answer", chunk.record);
    chunk.solved.columns = job->spool->append(bytes_of(from.columns()));
    ResultPart& traces = chunk.solved.traces.emplace();
    api::read_field(from, "trace_arrays", traces.arrays);
    traces.run = job->spool->append(bytes_of(from.traces()));
    chunks.push_back(std::move(chunk));
  }
  return chunks;
}

std::string pack(const PositionRequest& request) {
  return packed<store::disk::PositionRequest>(request);
}

PositionRequest unpack_request(const std::string& request) {
  return unpacked<store::disk::PositionRequest, PositionRequest>(request);
}

std::string pack(const SolvedPosition& position) {
  return packed<store::disk::SolvedPosition>(position);
}

SolvedPosition unpack_position(const std::string& body, std::size_t loads) {
  SolvedPosition position = unpacked<store::disk::SolvedPosition, SolvedPosition>(body);
  if (position.energy.size() != loads) throw damaged();
  return position;
}

}  // namespace anticrack::jobs

// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/from_domain.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "api/names.hpp"
#include "api/translations.hpp"
#include "jobs/sample_run.hpp"
#include "records/case_record.hpp"
#include "records/job_record.hpp"
#include "records/mesh_record.hpp"
#include "rpc/error_table.hpp"
#include "words/shown.hpp"

namespace anticrack::rpc {
namespace {

using contact::Status;

constexpr std::size_t max_warning_bytes = 500;
constexpr std::size_t max_detail_text = 200;

bool has_answer(Status status) {
  return status == Status::converged || status == Status::not_converged ||
         status == Status::cancelled;
}

/// Removes what clients do not see.
void present(const records::CaseRecord& record, v1::LoadCaseAnswer& answer) {
  if (!has_answer(record.status)) {
    v1::LoadCaseAnswer bare;
    bare.set_name(answer.name());
    bare.set_status(answer.status());
    answer = std::move(bare);
  }
  if (record.error) *answer.mutable_error() = to_message(*record.error);
  for (std::string& warning : *answer.mutable_warnings())
    warning = words::printable(warning, max_warning_bytes);
}

std::int32_t load_cases_ended(const records::JobRecord& record) {
  return static_cast<std::int32_t>(
      std::ranges::count_if(record.cases, [](const records::CaseRecord& each) {
        return has_answer(each.status) || each.status == Status::failed;
      }));
}

void clear_rows(v1::LoadCaseAnswer& answer) {
  answer.clear_tips();
  answer.clear_boundary();
}

}  // namespace

v1::LoadCaseAnswer from_domain(const records::CaseRecord& record, const std::string& name) {
  v1::LoadCaseAnswer answer = api::message(record);
  answer.set_name(name);
  present(record, answer);
  if (answer.ByteSizeLong() > max_job_message_bytes) clear_rows(answer);
  return answer;
}

v1::Job from_domain(const records::JobRecord& record) {
  v1::Job job = api::message(record);
  v1::JobStatus& status = *job.mutable_status();
  if (record.error) *status.mutable_error() = to_message(*record.error);
  for (int i = 0; i < status.answers_size(); ++i)
    present(record.cases[static_cast<std::size_t>(i)], *status.mutable_answers(i));
  for (v1::JobStatus::Step& step : *status.mutable_timeline())
    step.set_detail(words::printable(step.detail(), max_detail_text));
  status.set_load_case_count(job.spec().load_cases_size());
  status.set_load_cases_ended(load_cases_ended(record));
  if (job.ByteSizeLong() > max_job_message_bytes)
    for (v1::LoadCaseAnswer& answer : *status.mutable_answers()) clear_rows(answer);
  if (job.ByteSizeLong() > max_job_message_bytes)
    for (v1::LoadCaseAnswer& answer : *status.mutable_answers()) answer.clear_contact_intervals();
  if (job.ByteSizeLong() > max_job_message_bytes)
    for (v1::LoadCaseAnswer& answer : *status.mutable_answers()) answer.clear_warnings();
  return job;
}

v1::Job basic(records::JobRecord record) {
  const std::size_t load_cases = record.spec.loads.size();
  const std::int32_t ended = load_cases_ended(record);
  record.spec.loads.clear();
  record.cases.clear();
  record.timeline.clear();
  record.stages.clear();
  record.sweep.warnings.clear();
  if (record.spec.sweep) record.spec.sweep->traces.clear();
  v1::Job job = from_domain(record);
  job.mutable_status()->set_load_case_count(static_cast<std::int32_t>(load_cases));
  job.mutable_status()->set_load_cases_ended(ended);
  return job;
}

v1::Mesh from_domain(const records::MeshRecord& record, bool pinned) {
  v1::Mesh mesh = api::message(record);
  if (record.error) *mesh.mutable_error() = to_message(*record.error);
  mesh.set_pinned(pinned);
  return mesh;
}

v1::Upload from_domain(const store::UploadRecord& record, std::chrono::milliseconds ttl) {
  v1::Upload upload;
  upload.set_name(api::upload_name(record.id));
  if (record.bytes > 0)
    upload.set_kind(record.array ? v1::Upload::KIND_ARRAY : v1::Upload::KIND_MSH);
  upload.set_size(record.bytes);
  upload.set_owner(record.owner);
  api::write_field(record.created, upload, "create_time");
  if (ttl.count() > 0) api::write_field(record.created + ttl, upload, "expire_time");
  return upload;
}

void append(v1::Samples& samples, const std::vector<jobs::SampleRun>& runs) {
  using jobs::SamplePage;
  const auto column = [&runs]<class T>(google::protobuf::RepeatedField<T>& to,
                                       SamplePage::Column<T> SamplePage::*from) {
    std::size_t count = static_cast<std::size_t>(to.size());
    for (const jobs::SampleRun& run : runs) count += run.count;
    to.Reserve(static_cast<int>(count));
    for (const jobs::SampleRun& run : runs) {
      const std::span<const T> values = run.column(from);
      to.Add(values.begin(), values.end());
    }
  };
  column(*samples.mutable_load_case(), &SamplePage::load_case);
  column(*samples.mutable_iteration(), &SamplePage::iteration);
  column(*samples.mutable_criterion(), &SamplePage::criterion);
  column(*samples.mutable_energy(), &SamplePage::energy);
  column(*samples.mutable_contact_count(), &SamplePage::contact_count);
  column(*samples.mutable_kkt_gap(), &SamplePage::gap);
  column(*samples.mutable_kkt_sign(), &SamplePage::sign);
  column(*samples.mutable_kkt_complementarity(), &SamplePage::complementarity);
  column(*samples.mutable_kkt_equilibrium(), &SamplePage::equilibrium);
}

}  // namespace anticrack::rpc

// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <fstream>
#include <span>

#include "digest/digest.hpp"
#include "jobs/engine_support.hpp"
#include "records/case_record.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::throws;
using contact::Status;
using errors::Reason;
using records::JobRecord;
using records::JobState;
using ::testing::ElementsAre;

records::JobSpec two_loads(const std::string& mesh) {
  records::JobSpec spec = short_job(mesh);
  spec.loads.push_back({"push", -1.0, "x*y"});
  return spec;
}

TEST(EngineSolve, TakesAJobFromSubmissionToItsResult) {
  Engine test;
  const std::string mesh = test.backend.create();
  const JobRecord submitted = test.engine.submit({two_loads(mesh), "", ""});
  EXPECT_EQ(submitted.state, JobState::queued);
  EXPECT_EQ(submitted.id.size(), 16U);
  const JobRecord record = test.ended(submitted.id);
  EXPECT_EQ(record.state, JobState::succeeded);
  EXPECT_FALSE(record.error);
  ASSERT_TRUE(record.started && record.ended);
  EXPECT_LE(record.created, *record.started);
  EXPECT_LE(*record.started, *record.ended);
  ASSERT_EQ(record.cases.size(), 2U);
  for (const records::CaseRecord& solved : record.cases) {
    EXPECT_EQ(solved.status, Status::converged);
    EXPECT_GT(solved.answer.iterations, 1);
    EXPECT_EQ(solved.answer.inclusions.size(), 1U);
    EXPECT_GT(solved.solve_time.count(), 0);
  }
  EXPECT_EQ(test.state(submitted.id), JobState::succeeded);
  EXPECT_EQ(test.list().at(0).state, JobState::succeeded);
  const EngineMetrics metrics = test.engine.metrics();
  EXPECT_EQ(metrics.jobs_created, 1U);
  EXPECT_EQ(metrics.load_cases_ended, 2U);
  EXPECT_EQ(metrics.iterations, static_cast<std::uint64_t>(record.cases[0].answer.iterations +
                                                           record.cases[1].answer.iterations));
  EXPECT_EQ(metrics.jobs_queued, 0);
  EXPECT_EQ(metrics.jobs_running, 0);
}

TEST(EngineSolve, TellsEveryStepInOrder) {
  Engine test(one_thread());
  const std::string id = test.submit(two_loads(test.backend.create()));
  const JobRecord record = test.ended(id);
  const auto events = test.events(id);
  std::vector<int> iterations(2, 0);
  std::vector<int> ended;
  bool running = false;
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(events[i].sequence, i + 1);
    const Event& event = events[i].event;
    if (const auto* phase = std::get_if<PhaseEvent>(&event)) {
      EXPECT_FALSE(running);
      running = phase->state == JobState::running;
      EXPECT_TRUE(running || phase->state == JobState::waiting_for_mesh);
    } else if (const auto* sample = std::get_if<SampleEvent>(&event)) {
      EXPECT_TRUE(running);
      EXPECT_EQ(sample->sample.iteration,
                ++iterations.at(static_cast<std::size_t>(sample->load_case)));
    } else if (const auto* ended_case = std::get_if<CaseEvent>(&event)) {
      ended.push_back(ended_case->load_case);
      EXPECT_EQ(ended_case->record->answer.iterations,
                iterations.at(static_cast<std::size_t>(ended_case->load_case)));
    }
  }
  EXPECT_THAT(ended, ElementsAre(0, 1));
  EXPECT_TRUE(std::holds_alternative<EndEvent>(events.back().event));
}

TEST(EngineSolve, GivesTheArraysOfTheResult) {
  Engine test;
  const std::string mesh = test.ready_mesh();
  records::JobSpec spec = two_loads(mesh);
  spec.fields = true;
  const std::string id = test.submit(spec);
  const JobRecord record = test.ended(id);
  const auto block = test.engine.result(id);
  EXPECT_EQ(record.result_bytes, block->size());

  const auto s = array<double>(*block, "interfaces/0/s");
  const auto kind = array<std::int32_t>(*block, "interfaces/0/kind");
  ASSERT_TRUE(s && kind && array<double>(*block, "interfaces/0/x"));
  EXPECT_EQ(s->front(), 0);
  EXPECT_NEAR(s->back(), 2, 1e-12);
  EXPECT_EQ(kind->size(), s->size());
  EXPECT_EQ(array<double>(*block, "interfaces/0/y"), std::vector<double>(s->size(), 0.0));

  for (std::size_t load = 0; load < 2; ++load) {
    const std::string path = "loads/" + std::to_string(load) + "/";
    const auto u_minus = array<double>(*block, path + "traces/0/u_minus");
    const auto u_plus = array<double>(*block, path + "traces/0/u_plus");
    const auto jump = array<double>(*block, path + "traces/0/jump");
    ASSERT_TRUE(u_minus && u_plus && jump && array<double>(*block, path + "traces/0/pressure"));
    ASSERT_EQ(jump->size(), s->size());
    for (std::size_t i = 0; i < jump->size(); ++i) {
      EXPECT_NEAR((*jump)[i], (*u_plus)[i] - (*u_minus)[i], 1e-14);
    }
    EXPECT_EQ(array<std::int32_t>(*block, path + "traces/0/contact")->size(), s->size());

    const records::CaseRecord& solved = record.cases[load];
    const auto iteration = array<std::int32_t>(*block, path + "history/iteration");
    ASSERT_TRUE(iteration);
    EXPECT_EQ(iteration->size(), static_cast<std::size_t>(solved.answer.iterations));
    EXPECT_EQ(iteration->back(), solved.answer.iterations);
    EXPECT_EQ(array<double>(*block, path + "history/criterion")->back(), solved.answer.criterion);
    EXPECT_EQ(array<std::int32_t>(*block, path + "history/contact_count")->size(),
              iteration->size());
    for (const char* column :
         {"energy", "kkt_equilibrium", "kkt_gap", "kkt_sign", "kkt_complementarity"}) {
      EXPECT_EQ(array<double>(*block, path + "history/" + column)->size(), iteration->size());
    }
    for (const char* subdomain : {"0", "1"}) {
      EXPECT_EQ(array<double>(*block, path + "fields/" + subdomain)->size(),
                array<std::int32_t>(*block, std::string("fields/") + subdomain + "/nodes")->size());
    }
  }
}

TEST(EngineSolve, LeavesFieldsOutUnlessAskedFor) {
  Engine test;
  const std::string id = test.submit(short_job(test.ready_mesh()));
  test.ended(id);
  const auto block = test.engine.result(id);
  EXPECT_FALSE(array<double>(*block, "loads/0/fields/0"));
  EXPECT_FALSE(array<std::int32_t>(*block, "fields/0/nodes"));
}

TEST(EngineSolve, FactorisesNothingForTheSecondJobOnAMesh) {
  Engine test;
  const std::string mesh = test.ready_mesh();
  const auto before = test.backend.cache.metrics();
  test.ended(test.submit(short_job(mesh)));
  test.ended(test.submit(short_job(mesh)));
  const auto after = test.backend.cache.metrics();
  EXPECT_EQ(after.factorizations, before.factorizations);
  EXPECT_EQ(after.hits, before.hits + 2);
  EXPECT_EQ(test.backend.catalogue.meshings(), 1U);
}

TEST(EngineFailure, OfOneLoadCaseLeavesTheOthers) {
  Engine test(one_thread());
  records::JobSpec spec = short_job(test.ready_mesh());
  spec.loads.insert(spec.loads.begin(), {"nan", fem::Expression{"sqrt(-1 - x*x)"}, ""});
  spec.loads.push_back({"outside", 0.0, "", "", {{9, 9, 1}}});
  const std::string id = test.submit(spec);
  const JobRecord record = test.ended(id);
  EXPECT_EQ(record.state, JobState::not_converged);
  ASSERT_TRUE(record.error);
  EXPECT_EQ(record.error->reason(), Reason::expression_invalid);
  EXPECT_EQ(record.error->fields().at(0).field, "load_cases[0].force.expression");
  EXPECT_NE(std::string(record.error->what()).find("\"nan\""), std::string::npos);
  EXPECT_EQ(record.cases[0].status, Status::failed);
  EXPECT_EQ(record.cases[0].error->fields().at(0).field, "load_cases[0].force.expression");
  EXPECT_EQ(record.cases[1].status, Status::converged);
  EXPECT_EQ(record.cases[2].status, Status::failed);
  EXPECT_EQ(record.cases[2].error->fields().at(0).field, "load_cases[2].point_forces[0].at");
  const auto block = test.engine.result(id);
  EXPECT_FALSE(array<double>(*block, "loads/0/traces/0/jump"));
  EXPECT_TRUE(array<double>(*block, "loads/1/traces/0/jump"));
}

/// The bytes of the values as an upload; its name.
std::string upload_array(store::Store& store, const std::vector<double>& values) {
  const std::string part = store.new_upload_path(values.size() * sizeof(double));
  std::ofstream(part, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(double)));
  const std::string sha256 = digest::Sha256().add(std::as_bytes(std::span(values))).finish();
  store.keep_uploads({{part, sha256}}, "");
  return sha256;
}

TEST(EngineSolve, SolvesByTheActiveSetUnlessAskedOtherwise) {
  Engine test;
  records::JobSpec spec = two_loads(test.ready_mesh());
  const JobRecord uzawa = test.ended(test.submit(spec));
  spec.solver = {};
  const JobRecord exact = test.ended(test.submit(spec));
  ASSERT_EQ(exact.state, JobState::succeeded);
  for (std::size_t i = 0; i < 2; ++i) {
    const contact::AnswerSummary& answer = exact.cases[i].answer;
    EXPECT_EQ(exact.cases[i].status, Status::converged);
    EXPECT_LT(answer.iterations, 20);
    EXPECT_EQ(answer.theta, 0);
    EXPECT_NEAR(answer.inclusions.at(0).displacement_mesh,
                uzawa.cases[i].answer.inclusions.at(0).displacement_mesh, 1e-3);
  }
}

TEST(EngineSolve, TakesForcesFromUploadedArrays) {
  Engine test;
  const std::string mesh = test.ready_mesh();
  const std::uint64_t triangles = test.backend.catalogue.get(mesh).triangle_count;
  const std::uint64_t nodes = test.backend.catalogue.get(mesh).node_count;
  store::Store& store = *test.backend.store;
  const std::string ones = upload_array(store, std::vector<double>(triangles, 1.0));
  records::JobSpec spec = short_job(mesh);
  spec.loads = {{"constant", 1.0},
                {"triangles", fem::Array{ones, true}},
                {"again", fem::Array{ones, true}},
                {"nodes", fem::Array{upload_array(store, std::vector<double>(nodes, 1.0)), false}},
                {"not of this mesh", fem::Array{ones, false}}};
  const JobRecord record = test.ended(test.submit(spec));
  for (std::size_t i = 0; i < 4; ++i) {
    ASSERT_EQ(record.cases[i].status, Status::converged) << i;
    EXPECT_NEAR(record.cases[i].answer.energy, record.cases[0].answer.energy, 1e-12) << i;
  }
  EXPECT_EQ(record.cases[4].status, Status::failed);
  ASSERT_TRUE(record.cases[4].error);
  EXPECT_EQ(record.cases[4].error->fields().at(0).field, "load_cases[4].force.array");
  EXPECT_FALSE(std::get<fem::Array>(test.engine.get(record.id).spec.loads[1].force).values);
}

TEST(EngineSolve, TellsTheWarningsOfALoad) {
  Engine test;
  records::JobSpec spec = short_job(test.ready_mesh());
  spec.loads[0].force = fem::Expression{"y > 0 ? 1 : sin(1e5*x*y)/sqrt(abs(x - 0.03))"};
  const JobRecord record = test.ended(test.submit(spec));
  EXPECT_EQ(record.cases[0].answer.warnings.size(), 1U);
}

TEST(EngineFailure, OfTheMeshFailsTheJob) {
  Engine test;
  const records::UploadRef upload = test.backend.upload("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
  const std::string mesh = test.backend.catalogue.create(upload, "", "").id;
  const std::string id = test.submit(short_job(mesh));
  const JobRecord record = test.ended(id);
  EXPECT_EQ(record.state, JobState::failed);
  ASSERT_TRUE(record.error);
  EXPECT_EQ(record.error->reason(), Reason::mesh_invalid);
  EXPECT_EQ(record.error->fields().at(0).field, "mesh");
  EXPECT_EQ(record.cases[0].status, Status::failed);
  EXPECT_FALSE(record.started);
  EXPECT_TRUE(throws([&] { test.engine.result(id); }, Reason::not_ready));
}

TEST(EngineFailure, ToConvergeIsAnEndOfItsOwn) {
  Engine test;
  records::JobSpec spec = short_job(test.ready_mesh());
  uzawa_of(spec).epsilon = 1e-300;
  uzawa_of(spec).max_iterations = 3;
  const std::string id = test.submit(spec);
  const JobRecord record = test.ended(id);
  EXPECT_EQ(record.state, JobState::not_converged);
  EXPECT_EQ(record.cases[0].status, Status::not_converged);
  EXPECT_FALSE(record.cases[0].answer.reason.empty());
  EXPECT_THAT(*array<std::int32_t>(*test.engine.result(id), "loads/0/history/iteration"),
              ElementsAre(1, 2, 3));
}

TEST(EngineSubmit, ChecksTheJob) {
  Engine test;
  const std::string mesh = test.backend.create();
  EXPECT_TRUE(throws([&] { test.submit(short_job("unknown")); }, Reason::not_found, "mesh"));
  records::JobSpec spec = short_job(mesh);
  spec.loads[0].force = fem::Expression{"x +"};
  EXPECT_TRUE(throws([&] { test.submit(spec); }, Reason::expression_invalid,
                     "load_cases[0].force.expression"));
  EXPECT_TRUE(test.list().empty());
  EXPECT_TRUE(throws([&] { test.engine.get("unknown"); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { test.engine.events("unknown"); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { test.engine.result("unknown"); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { test.engine.cancel("unknown"); }, Reason::not_found));
  EXPECT_TRUE(throws([&] { test.engine.erase("unknown"); }, Reason::not_found));
}

TEST(EngineSubmit, LooksForTheArrays) {
  Engine test;
  records::JobSpec spec = short_job(test.backend.create());
  spec.loads.push_back({"array", fem::Array{std::string(64, 'b'), true}});
  EXPECT_TRUE(throws([&] { test.submit(spec); }, Reason::not_found, "load_cases[1].force.array"));
  const std::string part = test.backend.store->new_upload_path(100);
  std::ofstream(part) << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  test.backend.store->keep_uploads({{part, std::string(64, 'b')}}, "");
  EXPECT_TRUE(
      throws([&] { test.submit(spec); }, Reason::invalid_argument, "load_cases[1].force.array"));
  EXPECT_TRUE(test.list().empty());
}

TEST(EngineSubmit, GivesTheSameJobForTheSameRequest) {
  Engine test;
  const std::string mesh = test.ready_mesh();
  const std::string id = test.submit(short_job(mesh), "request");
  EXPECT_EQ(test.submit(short_job(mesh), "request"), id);
  test.ended(id);
  const JobRecord again = test.engine.get(test.submit(short_job(mesh), "request"));
  EXPECT_EQ(again.id, id);
  EXPECT_EQ(again.state, JobState::succeeded);
  EXPECT_TRUE(throws([&] { test.submit(two_loads(mesh), "request"); }, Reason::request_id_reused,
                     "request_id"));
  EXPECT_EQ(test.engine.metrics().jobs_created, 1U);
  test.engine.erase(id);
  EXPECT_NE(test.submit(short_job(mesh), "request"), id);
}

}  // namespace
}  // namespace anticrack::jobs

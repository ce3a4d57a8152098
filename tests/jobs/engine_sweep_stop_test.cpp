// SPDX-License-Identifier: GPL-3.0-or-later
//
// Sweeps that are stopped, passed by others, begun again, and whose end the disk refuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "jobs/sweep_support.hpp"
#include "support/errors.hpp"

namespace anticrack::jobs {
namespace {

using anticrack::testing::Backend;
using anticrack::testing::eventually;
using anticrack::testing::FailingStore;
using anticrack::testing::throws;
using errors::Reason;
using records::JobRecord;
using records::JobState;
using namespace std::chrono_literals;

constexpr std::size_t rows = 1000;  // four chunks

/// One thread, which looks for something else to do after every chunk.
EngineOptions short_turns() {
  EngineOptions options = one_thread();
  options.turn = 0ms;
  return options;
}

/// A sweep on an engine of one thread, on a mesh that is not factorised before the door is opened.
class EngineSweepStop : public ::testing::Test {
 protected:
  EngineSweepStop() : test(short_turns()) {
    test.backend.door.shut();
    mesh = test.backend.create(mesh_size);
  }

  records::JobSpec sweep(records::Priority priority = records::Priority::normal) {
    records::JobSpec spec = combinations(mesh, upload(test.backend, eighths(3 * rows)));
    spec.priority = priority;
    return spec;
  }
  /// Submits it, with something to do when the rows of its first chunk are told, on the thread that
  /// solves: nothing else is solved meanwhile.
  template <class Action>
  std::string submit(const records::JobSpec& spec, Action action) {
    std::string id = test.submit(spec);
    const std::shared_ptr<EventLog> log = test.engine.events(id);
    _listener = log->listen([this, log, id, action] {
      const auto last = log->read(log->latest() - 1, 1);
      if (std::holds_alternative<RowsEvent>(last.at(0).event) && !std::exchange(_told, true)) {
        action(id);
      }
    });
    test.backend.door.open();
    return id;
  }
  std::ptrdiff_t count(const std::string& id, std::int32_t status) const {
    const auto all = *array<std::int32_t>(*test.engine.result(id), "sweep/status");
    return std::count(all.begin(), all.end(), status);
  }
  std::size_t chunks_told(const std::string& id) const {
    return rows_told(*test.engine.events(id)).size();
  }

  Engine test;
  std::string mesh;

 private:
  bool _told = false;  ///< of the solver thread
  std::shared_ptr<EventLog::Listener> _listener;
};

TEST_F(EngineSweepStop, CancelledWhileQueued) {
  const std::string id = test.submit(sweep());
  test.engine.cancel(id);
  const JobRecord record = test.ended(id);
  EXPECT_EQ(record.state, JobState::cancelled);
  EXPECT_EQ(record.sweep.converged + record.sweep.failed, 0U);
  EXPECT_TRUE(throws([&] { test.engine.result(id); }, Reason::not_ready));
  EXPECT_EQ(test.engine.metrics().jobs_queued, 0);
  test.backend.door.open();
}

TEST_F(EngineSweepStop, CancelledBetweenChunksKeepsTheRowsItHas) {
  const std::string id = submit(sweep(), [&](const std::string& job) { test.engine.cancel(job); });
  const JobRecord record = test.ended(id);
  EXPECT_EQ(record.state, JobState::cancelled);
  EXPECT_FALSE(record.error);
  EXPECT_EQ(record.sweep.converged, 256U);
  EXPECT_EQ(record.sweep.failed, 0U);
  EXPECT_EQ(count(id, converged), 256);
  EXPECT_EQ(count(id, cancelled), static_cast<std::ptrdiff_t>(rows) - 256);
  EXPECT_EQ(chunks_told(id), 1U);
  EXPECT_EQ(test.engine.metrics().jobs_running, 0);
  EXPECT_EQ(test.ended(test.submit(sweep())).state, JobState::succeeded);
}

TEST_F(EngineSweepStop, FailsWhenItsTimeIsOver) {
  records::JobSpec spec = sweep();
  spec.run_time_limit = 1ms;
  const std::string id = submit(spec, [&](const std::string&) {
    // Limits are looked after in the order they are due: when a later one was, the sweep's was.
    records::JobSpec later = short_job(mesh);
    later.queue_time_limit = 50ms;
    test.ended(test.submit(later));
  });
  const JobRecord record = test.ended(id);
  EXPECT_EQ(record.state, JobState::failed);
  ASSERT_TRUE(record.error);
  EXPECT_EQ(record.error->reason(), Reason::timed_out);
  EXPECT_EQ(record.error->fields().at(0).field, "run_timeout");
  EXPECT_EQ(record.sweep.converged + record.sweep.failed, rows);
  EXPECT_LE(record.sweep.converged, 256U);
  if (record.sweep.converged > 0) {
    EXPECT_EQ(count(id, failed), static_cast<std::ptrdiff_t>(rows) - 256);
  }
}

TEST_F(EngineSweepStop, AnUrgentLoadCaseWaitsForOneChunkAtMost) {
  std::string urgent;
  std::size_t chunks_before = 0;
  std::shared_ptr<EventLog::Listener> listener;
  const std::string id = submit(sweep(records::Priority::bulk), [&](const std::string& bulk) {
    records::JobSpec spec = one_by_one(mesh, {1, 0, 0});
    spec.priority = records::Priority::interactive;
    urgent = test.submit(spec);
    const auto log = test.engine.events(urgent);
    listener = log->listen([&, log, bulk] {
      const auto last = log->read(log->latest() - 1, 1);
      if (std::holds_alternative<CaseEvent>(last.at(0).event)) {
        chunks_before = chunks_told(bulk);
      }
    });
  });
  EXPECT_EQ(test.ended(id).state, JobState::succeeded);
  EXPECT_EQ(test.ended(urgent).state, JobState::succeeded);
  listener.reset();
  EXPECT_EQ(chunks_before, 1U);
  EXPECT_EQ(chunks_told(id), 4U);
}

TEST(EngineSweepAgain, ManyRunAtOnceAndSomeAreCancelled) {
  EngineOptions options;
  options.threads = 2;
  options.turn = 1ms;
  Engine many(options);
  const std::string shared = many.ready_mesh(mesh_size);
  std::vector<std::string> ids;
  for (unsigned i = 0; i < 6; ++i) {
    ids.push_back(many.submit(combinations(shared, upload(many.backend, eighths(3 * rows, i)))));
    ids.push_back(many.submit(one_by_one(shared, eighths(12, i))));
  }
  for (std::size_t i = 0; i < ids.size(); i += 4) {
    many.engine.cancel(ids[i]);
  }
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const JobRecord record = many.ended(ids[i]);
    EXPECT_TRUE(record.state == JobState::succeeded ||
                (i % 4 == 0 && record.state == JobState::cancelled));
  }
  EXPECT_TRUE(eventually([&] { return many.engine.idle(); }));
  EXPECT_EQ(many.engine.metrics().columns, 0);
  EXPECT_EQ(many.engine.metrics().queued_bytes, 0U);
}

TEST(EngineSweepAgain, AfterACrashItRunsFromTheStart) {
  Backend backend;
  const std::string mesh = ready_mesh(backend, mesh_size);
  const records::JobSpec spec = combinations(mesh, upload(backend, eighths(3 * rows)));
  JobRecord crashed;
  crashed.id = "0123456789abcdef";
  crashed.spec = spec;
  crashed.spec.sweep->rows = rows;
  crashed.created = records::Clock::now();
  backend.store->create(crashed, "fingerprint");
  crashed.state = JobState::running;
  crashed.started = records::Clock::now();
  crashed.sweep.converged = 17;
  backend.store->put(crashed);

  JobEngine engine(one_thread(), *backend.store, backend.catalogue);
  const JobRecord record = ended(engine, crashed.id);
  EXPECT_EQ(record.state, JobState::succeeded);
  EXPECT_EQ(record.attempt, 2);
  EXPECT_EQ(record.sweep.converged, rows);
  const std::string fresh = engine.submit({spec, "", ""}).id;
  ended(engine, fresh);
  EXPECT_EQ(engine.result(crashed.id)->sha256(), engine.result(fresh)->sha256());
}

TEST(EngineSweepAgain, IsLeftToTheNextStartByAStop) {
  Backend backend;
  const std::string mesh = ready_mesh(backend, mesh_size);
  const records::JobSpec spec = combinations(mesh, upload(backend, eighths(3 * 10 * rows)));
  std::string id;
  {
    JobEngine engine(one_thread(), *backend.store, backend.catalogue);
    id = engine.submit({spec, "", ""}).id;
    engine.stop(0ms);
    if (engine.get(id).state == JobState::queued) {
      EXPECT_EQ(engine.get(id).sweep.converged, 0U);
      EXPECT_FALSE(records::ended(backend.store->job(id)->state));
    } else {
      EXPECT_EQ(engine.get(id).state, JobState::succeeded);
    }
  }
  JobEngine engine(one_thread(), *backend.store, backend.catalogue);
  EXPECT_EQ(ended(engine, id).state, JobState::succeeded);
  EXPECT_EQ(engine.get(id).sweep.converged, 10 * rows);
}

TEST(EngineSweepAgain, AMatrixThatIsGoneFailsTheJob) {
  Backend backend;
  const std::string mesh = ready_mesh(backend, mesh_size);
  JobRecord left;
  left.id = "0123456789abcdef";
  left.spec = combinations(mesh, std::string(64, 'a'));
  left.spec.sweep->rows = 5;
  left.created = records::Clock::now();
  backend.store->create(left, "fingerprint");
  JobEngine engine(one_thread(), *backend.store, backend.catalogue);
  const JobRecord record = ended(engine, left.id);
  EXPECT_EQ(record.state, JobState::failed);
  ASSERT_TRUE(record.error);
  EXPECT_EQ(record.error->reason(), Reason::not_found);
  EXPECT_EQ(record.error->fields().at(0).field, "sweep.coefficients");
  EXPECT_EQ(record.sweep.failed, 5U);
}

TEST(EngineSweepAgain, IsWrittenWhenTheDiskHasSpace) {
  Backend backend;
  FailingStore& store = *backend.store;
  const std::string mesh = ready_mesh(backend, mesh_size);
  JobEngine engine(one_thread(), store, backend.catalogue);
  store.finish_fails = true;
  const std::string id =
      engine.submit({combinations(mesh, upload(backend, eighths(3 * rows))), "", ""}).id;
  EXPECT_TRUE(eventually([&] { return store.failures > 0; }));
  EXPECT_EQ(engine.get(id).state, JobState::running);
  EXPECT_EQ(engine.get(id).sweep.converged, rows);
  EXPECT_EQ(engine.get(id).spec.sweep->rows, rows);
  store.finish_fails = false;
  const JobRecord record = ended(engine, id);
  EXPECT_EQ(record.state, JobState::succeeded);
  EXPECT_EQ(record.sweep.converged, rows);
  EXPECT_EQ(array<double>(*engine.result(id), "sweep/energy")->size(), rows);
}

}  // namespace
}  // namespace anticrack::jobs

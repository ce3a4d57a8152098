// SPDX-License-Identifier: GPL-3.0-or-later
//
// A thousand watchers that read one message and no more, and a client beside them.
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <memory>
#include <mutex>

#include "anticrack/v1/solve.grpc.pb.h"
#include "client/jobs.hpp"
#include "service/daemon.hpp"
#include "service/workload.hpp"
#include "support/eventually.hpp"

namespace anticrack::service_test {
namespace {

/// Counts what is open; the last to leave wakes who waits.
struct Crowd {
  std::mutex mutex;
  std::condition_variable left;
  int reading = 0;  ///< have had their first message
  int open = 0;
};

/// Reads the snapshot and then nothing, until it is cancelled. Deletes itself when it is over.
class LazyWatcher : public grpc::ClientReadReactor<v1::WatchJobResponse> {
 public:
  LazyWatcher(Crowd& crowd, v1::SolveService::Stub& stub, grpc::ClientContext& context,
              const v1::WatchJobRequest& request)
      : _crowd(crowd) {
    stub.async()->WatchJob(&context, &request, this);
    StartRead(&_message);
    StartCall();
  }

  void OnReadDone(bool fine) override {
    const std::lock_guard lock(_crowd.mutex);
    _crowd.reading += fine ? 1 : 0;
  }
  void OnDone(const grpc::Status&) override {
    {
      const std::lock_guard lock(_crowd.mutex);
      --_crowd.open;
      _crowd.left.notify_all();
    }
    delete this;
  }

 private:
  Crowd& _crowd;
  v1::WatchJobResponse _message;
};

TEST(Watchers, AThousandLazyOnesCostNobodyElseAnything) {
  constexpr int many = 1'000;
  const Daemon daemon;
  client::Connection connection(daemon.connection());
  const Work endless = work("paper-3.toml", {"solver.theta=1e-7", "solver.epsilon=1e-300",
                                             "solver.max_iterations=1000000"});
  const std::string watched = submit(connection, endless, client::make_uuid()).name();

  const auto stub = v1::SolveService::NewStub(
      grpc::CreateChannel(daemon.address(), grpc::InsecureChannelCredentials()));
  v1::WatchJobRequest request;
  request.set_name(watched);
  Crowd crowd;
  crowd.open = many;
  std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
  for (int i = 0; i < many; ++i) {
    contexts.push_back(std::make_unique<grpc::ClientContext>());
    new LazyWatcher(crowd, *stub, *contexts.back(), request);  // NOLINT: owned by its call
  }
  EXPECT_TRUE(anticrack::testing::eventually([&] {
    const std::lock_guard lock(crowd.mutex);
    return crowd.reading == many;
  }));
  EXPECT_GE(client::server_info(connection).metrics().watchers(), many);

  const std::string other = submit(connection, work("paper-1.toml"), client::make_uuid()).name();
  EXPECT_EQ(wait_for_end(connection, other).status().state(), v1::JobStatus::STATE_SUCCEEDED);
  EXPECT_NO_THROW(client::read_result(connection, other));
  client::cancel_job(connection, watched);
  EXPECT_EQ(wait_for_end(connection, watched).status().state(), v1::JobStatus::STATE_CANCELLED);

  for (const auto& context : contexts) context->TryCancel();
  std::unique_lock lock(crowd.mutex);
  crowd.left.wait(lock, [&] { return crowd.open == 0; });
}

}  // namespace
}  // namespace anticrack::service_test

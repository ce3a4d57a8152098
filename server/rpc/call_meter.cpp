// SPDX-License-Identifier: GPL-3.0-or-later
#include "rpc/call_meter.hpp"

#include <chrono>
#include <string>

namespace anticrack::rpc {
namespace {

namespace interceptors = grpc::experimental;
using Clock = std::chrono::steady_clock;

class Meter final : public interceptors::Interceptor {
 public:
  Meter(const CallListener& listener, const char* method) : _listener(listener), _method(method) {}

  void Intercept(interceptors::InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(interceptors::InterceptionHookPoints::PRE_SEND_STATUS))
      _listener(_method, methods->GetSendStatus().error_code(), Clock::now() - _begin);
    methods->Proceed();
  }

 private:
  const CallListener& _listener;
  const std::string _method;
  const Clock::time_point _begin = Clock::now();
};

class MeterFactory final : public interceptors::ServerInterceptorFactoryInterface {
 public:
  explicit MeterFactory(CallListener listener) : _listener(std::move(listener)) {}

  interceptors::Interceptor* CreateServerInterceptor(interceptors::ServerRpcInfo* info) override {
    return new Meter(_listener, info->method());  // gRPC deletes it
  }

 private:
  const CallListener _listener;
};

}  // namespace

std::vector<std::unique_ptr<interceptors::ServerInterceptorFactoryInterface>> call_meters(
    const CallListener& listener) {
  std::vector<std::unique_ptr<interceptors::ServerInterceptorFactoryInterface>> meters;
  if (listener) meters.push_back(std::make_unique<MeterFactory>(listener));
  return meters;
}

}  // namespace anticrack::rpc

// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/every_look.hpp"

#include <chrono>
#include <mutex>
#include <thread>
#include <utility>

#include "stop/stop.hpp"

namespace anticrack::testing {

struct EveryLook::State {
  std::mutex mutex;
  std::string doing;
  std::size_t number = 0;
  std::function<void()> act;
  bool acts = false, acted = false;
  std::map<std::string, std::size_t> before;
  std::vector<std::string> after;

  void look(const char* what) {
    const stop::Asked asked = stop::asked();
    {
      std::unique_lock lock(mutex);
      if (acted) {
        lock.unlock();
        const bool stopped = asked && asked({what, 0});
        lock.lock();
        // A thread that comes to something new and is sent home there has not begun it.
        if (before.count(what) > 0 || !stopped) after.emplace_back(what);
        return;
      }
      if (++before[what] != number || doing != what || std::exchange(acts, true)) return;
    }
    std::thread(act).join();
    // A stop may reach this thread by way of others.
    const auto most = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!(asked && asked({what, 0})) && std::chrono::steady_clock::now() < most)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::lock_guard lock(mutex);
    acted = true;
  }
};

namespace {

std::mutex hearing;
std::shared_ptr<EveryLook::State> heard;

void hear(const char* doing) {
  std::shared_ptr<EveryLook::State> state;
  {
    const std::lock_guard lock(hearing);
    state = heard;
  }
  if (state) state->look(doing);
}

}  // namespace

EveryLook::EveryLook(std::string doing, std::size_t number, std::function<void()> act)
    : _state(std::make_shared<State>()) {
  _state->doing = std::move(doing);
  _state->number = number;
  _state->act = std::move(act);
  const std::lock_guard lock(hearing);
  heard = _state;
}

EveryLook::~EveryLook() {
  const std::lock_guard lock(hearing);
  heard = nullptr;
}

bool EveryLook::acted() const {
  const std::lock_guard lock(_state->mutex);
  return _state->acted;
}

std::map<std::string, std::size_t> EveryLook::before() const {
  const std::lock_guard lock(_state->mutex);
  return _state->before;
}

std::vector<std::string> EveryLook::after() const {
  const std::lock_guard lock(_state->mutex);
  return _state->after;
}

}  // namespace anticrack::testing

// The linker passes calls of stop::look() to the first; the second is stop::look() (ld --wrap).
// NOLINTBEGIN(bugprone-reserved-identifier): the linker makes these names
extern "C" void __real__ZN9anticrack4stop4lookEPKcm(const char* doing, std::size_t done);
extern "C" void __wrap__ZN9anticrack4stop4lookEPKcm(const char* doing, std::size_t done) {
  anticrack::testing::hear(doing);
  __real__ZN9anticrack4stop4lookEPKcm(doing, done);
}
// NOLINTEND(bugprone-reserved-identifier)

// SPDX-License-Identifier: GPL-3.0-or-later
#include "expression/evaluator.hpp"

#include <algorithm>
#include <utility>

namespace anticrack::expression {
namespace {

/// Measured time of a point by Code, in ns.
#define COST(code, name, cost, value) cost,
constexpr double costs[] = {0, 0, 0, ANTICRACK_OPERATIONS(COST)};
#undef COST

}  // namespace

Evaluator::Evaluator(const Tape& tape, std::span<const Ref> roots) {
  const std::vector<Operation>& operations = tape.operations();
  // The last operation that uses each result; roots are kept to the end.
  const std::size_t never = operations.size() + 1;
  std::vector<std::size_t> last_use(operations.size(), 0);
  const std::vector<bool> needed = tape.needed(roots);
  for (std::size_t i = 0; i < operations.size(); ++i) {
    for (const Ref of : operations[i].of)
      if (needed[i] && of >= 0) last_use[static_cast<std::size_t>(of)] = i;
  }
  for (const Ref root : roots) last_use[static_cast<std::size_t>(root)] = never;
  std::vector<std::size_t> slot(operations.size(), 0), unused;
  std::vector<std::pair<std::size_t, double>> constants;
  std::size_t slots = 2;
  for (std::size_t i = 0; i < operations.size(); ++i) {
    const Operation& operation = operations[i];
    if (!needed[i]) continue;
    if (operation.code == Code::x || operation.code == Code::y) {
      slot[i] = operation.code == Code::x ? 0 : 1;
      continue;
    }
    if (operation.code == Code::constant) {
      slot[i] = slots++;
      constants.emplace_back(slot[i], operation.value);
      continue;
    }
    const auto operand = [&](std::size_t k) {
      return operation.of[k] < 0 ? 0 : slot[static_cast<std::size_t>(operation.of[k])];
    };
    Step step{fastest_kernels()[static_cast<std::size_t>(operation.code)], operand(0), operand(1),
              operand(2), 0};
    for (const Ref of : operation.of) {  // an operation may overwrite its operands
      const auto k = static_cast<std::size_t>(of);
      if (of >= 0 && last_use[k] == i && operations[k].code > Code::y) {
        unused.push_back(slot[k]);
        last_use[k] = 0;  // the same operand twice is freed once
      }
    }
    if (unused.empty()) {
      step.out = slots++;
    } else {
      step.out = unused.back();
      unused.pop_back();
    }
    slot[i] = step.out;
    _steps.push_back(step);
    _cost += costs[static_cast<std::size_t>(operation.code)];
  }
  _storage.resize((slots - 2) * block);
  _pointers.resize(slots);
  _writable.resize(slots);
  for (std::size_t s = 2; s < slots; ++s) {
    _writable[s] = &_storage[(s - 2) * block];
    _pointers[s] = _writable[s];
  }
  for (const auto& [place, value] : constants) std::fill_n(_writable[place], block, value);
  for (const Ref root : roots) _roots.push_back(slot[static_cast<std::size_t>(root)]);
}

void Evaluator::operator()(const double* x, const double* y, std::size_t n) {
  _pointers[0] = x;
  _pointers[1] = y;
  for (const Step& step : _steps)
    step.kernel(_pointers[step.a], _pointers[step.b], _pointers[step.c], _writable[step.out], n);
}

}  // namespace anticrack::expression

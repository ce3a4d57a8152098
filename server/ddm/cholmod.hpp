// SPDX-License-Identifier: GPL-3.0-or-later
//
// CHOLMOD's context, owners of its memory and its errors; the only header that includes it.
#pragma once

#include <cholmod.h>

#include <memory>

namespace anticrack::ddm {

/// The calling thread's cholmod_common: workspace and status, never shared among threads.
cholmod_common& cholmod_context();

struct FreeFactor {
  void operator()(cholmod_factor* factor) const;
};

/// May be freed by any thread: memory comes from malloc.
using FactorPtr = std::unique_ptr<cholmod_factor, FreeFactor>;

/// Throws errors::Error (numerical, or limit_exceeded for memory) unless CHOLMOD's last call on
/// this thread succeeded; `doing` says what it was.
void require_success(const cholmod_common& context, const char* doing);

}  // namespace anticrack::ddm

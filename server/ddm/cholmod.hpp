// SPDX-License-Identifier: GPL-3.0-or-later
//
// Owners for what CHOLMOD allocates. The only header that shows CHOLMOD.
#pragma once

#include <cholmod.h>

#include <memory>

namespace anticrack::ddm {

/// The calling thread's cholmod_common: workspace and status, never shared among threads.
cholmod_common& cholmod_context();

struct FreeSparse {
  void operator()(cholmod_sparse* matrix) const;
};
struct FreeFactor {
  void operator()(cholmod_factor* factor) const;
};
struct FreeDense {
  void operator()(cholmod_dense* matrix) const;
};

using SparsePtr = std::unique_ptr<cholmod_sparse, FreeSparse>;
/// May be freed by another thread than the one that made it: memory comes from malloc.
using FactorPtr = std::unique_ptr<cholmod_factor, FreeFactor>;
using DensePtr = std::unique_ptr<cholmod_dense, FreeDense>;

/// Throws errors::Error (numerical, or limit_exceeded for memory) unless CHOLMOD's last call on
/// this thread succeeded; `doing` says what it was.
void require_success(const cholmod_common& context, const char* doing);

}  // namespace anticrack::ddm

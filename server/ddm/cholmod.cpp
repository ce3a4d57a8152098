// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/cholmod.hpp"

#include <string>

#include "base/at.hpp"
#include "ddm/blas.hpp"
#include "errors/errors.hpp"

// Declared here, as OpenMP's header is not included: compiling with OpenMP would make Eigen start
// threads as well. Debian's libcholmod is linked with OpenMP's run-time library.
extern "C" void omp_set_max_active_levels(int);

namespace anticrack::ddm {
namespace {

class Context {
 public:
  Context() {
    require_threadsafe_blas();
    // CHOLMOD starts four threads in every call. Our threads run in parallel already; with no
    // active levels the calling thread works alone.
    omp_set_max_active_levels(0);
    cholmod_start(&_common);
    _common.print = 0;  // otherwise it writes to the standard output
    _common.nmethods = 1;
    _common.method[0].ordering = CHOLMOD_GIVEN;
    _common.supernodal = CHOLMOD_SUPERNODAL;
    _common.final_ll = 1;
    _common.quick_return_if_not_posdef = 1;
    // Fraction of zeros allowed in amalgamated supernodes: a quarter of CHOLMOD's default, since
    // our small fronts are cheap. The factor gets a seventh smaller and takes no longer.
    _common.zrelax[0] = 0.2;
    _common.zrelax[1] = 0.05;
    _common.zrelax[2] = 0.02;
  }
  ~Context() { cholmod_finish(&_common); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  cholmod_common& common() noexcept { return _common; }

 private:
  cholmod_common _common{};
};

/// The calling thread's workspace and status, never shared among threads.
cholmod_common& cholmod_context() {
  thread_local Context context;
  return context.common();
}

/// CHOLMOD's view of the lower triangle of a compressed symmetric matrix, which it only reads.
cholmod_sparse view(const Eigen::SparseMatrix<double>& matrix) {
  cholmod_sparse result{};
  result.nrow = at(matrix.rows());
  result.ncol = at(matrix.cols());
  result.nzmax = at(matrix.nonZeros());
  result.p = const_cast<int*>(matrix.outerIndexPtr());
  result.i = const_cast<int*>(matrix.innerIndexPtr());
  result.x = const_cast<double*>(matrix.valuePtr());
  result.stype = -1;
  result.itype = CHOLMOD_INT;
  result.xtype = CHOLMOD_REAL;
  result.dtype = CHOLMOD_DOUBLE;
  result.sorted = 1;
  result.packed = 1;
  return result;
}

bool keeps_trace_last(const cholmod_factor& factor, Eigen::Index interior) {
  const int* permutation = static_cast<const int*>(factor.Perm);
  for (auto i = at(interior); i < factor.n; ++i)
    if (permutation[i] != static_cast<int>(i)) return false;
  return true;
}

FactorPtr analyse(cholmod_sparse& matrix, std::vector<int>& permutation, bool postorder) {
  cholmod_common& context = cholmod_context();
  context.postorder = postorder ? 1 : 0;
  FactorPtr factor(cholmod_analyze_p(&matrix, permutation.data(), nullptr, 0, &context));
  if (context.status == CHOLMOD_OUT_OF_MEMORY || context.status == CHOLMOD_TOO_LARGE) {
    throw errors::Error(
        errors::Reason::limit_exceeded,
        "no memory for the analysis of a subdomain; take a coarser mesh (larger size or tip_size)");
  }
  if (context.status != CHOLMOD_OK) {
    throw errors::Error(errors::Reason::internal,
                        "CHOLMOD status {} in the analysis of a subdomain", context.status);
  }
  return factor;
}

}  // namespace

void FreeFactor::operator()(cholmod_factor* factor) const {
  cholmod_free_factor(&factor, &cholmod_context());
}

FactorPtr analyse(const Eigen::SparseMatrix<double>& lower, std::vector<int> permutation,
                  Eigen::Index interior) {
  cholmod_sparse matrix = view(lower);
  FactorPtr factor = analyse(matrix, permutation, true);
  // The interface is a clique at the root of the elimination tree, so postordering keeps it last,
  // unless the interior is disconnected and the tree has several roots.
  if (!keeps_trace_last(*factor, interior)) {
    factor = analyse(matrix, permutation, false);
    if (!keeps_trace_last(*factor, interior)) {
      throw errors::Error(errors::Reason::internal,
                          "the analysis of a subdomain moved its interface nodes");
    }
  }
  if (factor->is_super == 0)
    throw errors::Error(errors::Reason::internal, "CHOLMOD found no supernodes");
  return factor;
}

}  // namespace anticrack::ddm

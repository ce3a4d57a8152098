// SPDX-License-Identifier: GPL-3.0-or-later
#include "ddm/cholmod.hpp"

#include <string>

#include "ddm/blas.hpp"
#include "errors/errors.hpp"

// From OpenMP's run-time library, which Debian's libcholmod is linked with. Its header is not
// included: compiling with OpenMP would make Eigen start threads as well.
extern "C" void omp_set_max_active_levels(int);

namespace anticrack::ddm {
namespace {

class Context {
 public:
  Context() {
    require_threadsafe_blas();
    // CHOLMOD starts four threads in every factorisation. Ours run in parallel already; without
    // active levels the calling thread works alone.
    omp_set_max_active_levels(0);
    cholmod_start(&_common);
    _common.print = 0;  // it would write to the standard output
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

}  // namespace

cholmod_common& cholmod_context() {
  thread_local Context context;
  return context.common();
}

void FreeFactor::operator()(cholmod_factor* factor) const {
  cholmod_free_factor(&factor, &cholmod_context());
}

void require_success(const cholmod_common& context, const char* doing) {
  switch (context.status) {
    case CHOLMOD_OK:
    case CHOLMOD_DSMALL:
      return;
    case CHOLMOD_OUT_OF_MEMORY:
    case CHOLMOD_TOO_LARGE:
      throw errors::Error(errors::Reason::limit_exceeded,
                          std::string("no memory for ") + doing + "; take a coarser mesh");
    case CHOLMOD_NOT_POSDEF:
      throw errors::Error(errors::Reason::numerical,
                          std::string("the stiffness matrix is not positive definite in ") + doing +
                              "; the mesh has triangles that are degenerate, or is badly scaled");
    default:
      throw errors::Error(
          errors::Reason::internal,
          std::string("CHOLMOD status ") + std::to_string(context.status) + " in " + doing);
  }
}

}  // namespace anticrack::ddm

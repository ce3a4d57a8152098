// SPDX-License-Identifier: GPL-3.0-or-later
//
// Solvers with bounds off the shelf, on the unknowns with jumps d >= 0.
#include <stdexcept>

#include "benchmarks/peers/petsc.hpp"

namespace anticrack::benchmarks {
namespace {

/// K x - f with x >= bound; K in full, as CHOLMOD and the submatrices of the solvers take it.
class BoundedProblem {
 public:
  explicit BoundedProblem(const PlainMesh& mesh)
      : _mesh(mesh), _system(assemble(mesh, Minus::jumps)) {
    Mat half = symmetric_matrix(_system);
    require(MatConvert(half, MATSEQAIJ, MAT_INITIAL_MATRIX, &matrix), "MatConvert");
    MatDestroy(&half);
    require(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE), "MatSetOption");
    require(MatSetOption(matrix, MAT_SPD, PETSC_TRUE), "MatSetOption");
    for (Vec* vector : {&x, &load, &lower, &upper, &work}) {
      require(MatCreateVecs(matrix, vector, nullptr), "MatCreateVecs");
    }
    require(VecSet(upper, PETSC_INFINITY), "VecSet");
    require(VecSet(lower, PETSC_NINFINITY), "VecSet");
    for (PetscInt i = _system.interior(); i < _system.displacement(0); ++i) {
      require(VecSetValue(lower, i, 0, INSERT_VALUES), "VecSetValue");
    }
    require(VecAssemblyBegin(lower), "VecAssembly");
    require(VecAssemblyEnd(lower), "VecAssembly");
  }
  ~BoundedProblem() {
    for (Vec* vector : {&x, &load, &lower, &upper, &work}) VecDestroy(vector);
    MatDestroy(&matrix);
  }
  BoundedProblem(const BoundedProblem&) = delete;
  BoundedProblem& operator=(const BoundedProblem&) = delete;

  void begin(const std::vector<double>& nodal_force) {
    const std::vector<double> values = load_vector(_mesh, _system, nodal_force);
    double* to = nullptr;
    require(VecGetArrayWrite(load, &to), "VecGetArrayWrite");
    std::copy(values.begin(), values.end(), to);
    VecRestoreArrayWrite(load, &to);
    require(VecSet(x, 0), "VecSet");
  }
  PeerAnswer answer(int steps) {
    PeerAnswer result;
    result.steps = steps;
    result.energy = energy(x);
    const PetscInt first = _system.displacement(0);
    require(VecGetValues(x, 1, &first, &result.displacement), "VecGetValues");
    return result;
  }
  /// x'K x / 2 - f'x; leaves K x in `work`.
  double energy(Vec at) {
    double quadratic = 0, linear = 0;
    require(MatMult(matrix, at, work), "MatMult");
    require(VecDot(at, work, &quadratic), "VecDot");
    require(VecDot(at, load, &linear), "VecDot");
    return 0.5 * quadratic - linear;
  }
  PetscErrorCode gradient(Vec at, Vec to) {
    PetscFunctionBeginUser;
    PetscCall(MatMult(matrix, at, to));
    PetscCall(VecAXPY(to, -1, load));
    PetscFunctionReturn(0);
  }

  Mat matrix = nullptr;
  Vec x = nullptr, load = nullptr, lower = nullptr, upper = nullptr, work = nullptr;

 private:
  const PlainMesh& _mesh;
  Monolithic _system;
};

void use_cholmod(KSP ksp) {
  PC pc = nullptr;
  require(KSPGetPC(ksp, &pc), "KSPGetPC");
  require(PCSetType(pc, PCCHOLESKY), "PCSetType");
  require(PCFactorSetMatSolverType(pc, MATSOLVERCHOLMOD), "PCFactorSetMatSolverType");
}

class SnesviPeer : public Peer {
 public:
  explicit SnesviPeer(const PlainMesh& mesh) : _problem(mesh) {
    require(SNESCreate(PETSC_COMM_SELF, &_snes), "SNESCreate");
    require(SNESSetType(_snes, SNESVINEWTONRSLS), "SNESSetType");
    require(SNESSetFunction(_snes, _problem.work, function, &_problem), "SNESSetFunction");
    require(SNESSetJacobian(_snes, _problem.matrix, _problem.matrix, jacobian, &_problem),
            "SNESSetJacobian");
    require(SNESVISetVariableBounds(_snes, _problem.lower, _problem.upper), "the bounds");
    require(SNESSetTolerances(_snes, 1e-14, 1e-10, 0, 200, 10'000), "SNESSetTolerances");
    SNESLineSearch search = nullptr;
    require(SNESGetLineSearch(_snes, &search), "SNESGetLineSearch");
    require(SNESLineSearchSetType(search, SNESLINESEARCHBASIC), "SNESLineSearchSetType");
    KSP ksp = nullptr;
    require(SNESGetKSP(_snes, &ksp), "SNESGetKSP");
    require(KSPSetType(ksp, KSPPREONLY), "KSPSetType");
    use_cholmod(ksp);
  }
  ~SnesviPeer() override { SNESDestroy(&_snes); }
  SnesviPeer(const SnesviPeer&) = delete;
  SnesviPeer& operator=(const SnesviPeer&) = delete;

  PeerAnswer solve(const std::vector<double>& nodal_force) override {
    _problem.begin(nodal_force);
    require(SNESSolve(_snes, nullptr, _problem.x), "SNESSolve");
    SNESConvergedReason reason = SNES_CONVERGED_ITERATING;
    PetscInt steps = 0;
    SNESGetConvergedReason(_snes, &reason);
    SNESGetIterationNumber(_snes, &steps);
    if (reason <= 0) throw std::runtime_error("SNESVI did not converge");
    return _problem.answer(static_cast<int>(steps));
  }

 private:
  static PetscErrorCode function(SNES, Vec x, Vec f, void* problem) {
    return static_cast<BoundedProblem*>(problem)->gradient(x, f);
  }
  static PetscErrorCode jacobian(SNES, Vec, Mat, Mat, void*) { return 0; }  // it is constant

  BoundedProblem _problem;
  SNES _snes = nullptr;
};

class TronPeer : public Peer {
 public:
  explicit TronPeer(const PlainMesh& mesh) : _problem(mesh) {
    require(TaoCreate(PETSC_COMM_SELF, &_tao), "TaoCreate");
    require(TaoSetType(_tao, TAOTRON), "TaoSetType");
    require(TaoSetSolution(_tao, _problem.x), "TaoSetSolution");
    require(TaoSetVariableBounds(_tao, _problem.lower, _problem.upper), "the bounds");
    require(TaoSetObjectiveAndGradient(_tao, nullptr, value, &_problem), "the objective");
    require(TaoSetHessian(_tao, _problem.matrix, _problem.matrix, hessian, &_problem),
            "TaoSetHessian");
    require(TaoSetTolerances(_tao, 1e-12, 0, 0), "TaoSetTolerances");
    require(TaoSetMaximumIterations(_tao, 1000), "TaoSetMaximumIterations");
    KSP ksp = nullptr;
    require(TaoGetKSP(_tao, &ksp), "TaoGetKSP");
    require(KSPSetTolerances(ksp, 1e-10, 1e-30, PETSC_DEFAULT, 100), "KSPSetTolerances");
    use_cholmod(ksp);
  }
  ~TronPeer() override { TaoDestroy(&_tao); }
  TronPeer(const TronPeer&) = delete;
  TronPeer& operator=(const TronPeer&) = delete;

  PeerAnswer solve(const std::vector<double>& nodal_force) override {
    _problem.begin(nodal_force);
    require(TaoSolve(_tao), "TaoSolve");
    TaoConvergedReason reason = TAO_CONTINUE_ITERATING;
    PetscInt steps = 0;
    TaoGetConvergedReason(_tao, &reason);
    TaoGetIterationNumber(_tao, &steps);
    if (reason <= 0) throw std::runtime_error("TRON did not converge");
    return _problem.answer(static_cast<int>(steps));
  }

 private:
  static PetscErrorCode value(Tao, Vec x, double* energy, Vec gradient, void* context) {
    auto* problem = static_cast<BoundedProblem*>(context);
    *energy = problem->energy(x);
    return problem->gradient(x, gradient);
  }
  static PetscErrorCode hessian(Tao, Vec, Mat, Mat, void*) { return 0; }

  BoundedProblem _problem;
  Tao _tao = nullptr;
};

}  // namespace

std::unique_ptr<Peer> snesvi_peer(const PlainMesh& mesh) {
  return std::make_unique<SnesviPeer>(mesh);
}

std::unique_ptr<Peer> tron_peer(const PlainMesh& mesh) { return std::make_unique<TronPeer>(mesh); }

}  // namespace anticrack::benchmarks

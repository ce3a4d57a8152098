// SPDX-License-Identifier: GPL-3.0-or-later
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>

#include "benchmarks/peers/dense_active_set.hpp"
#include "benchmarks/peers/petsc.hpp"

namespace anticrack::benchmarks {
namespace {

/// With the last unknowns t = (u-, A) and S on them, u- = A - d: S^ d - r >= 0 as A is eliminated.
class SchurPeer : public Peer {
 public:
  SchurPeer(const PlainMesh& mesh, int ordering)
      : _mesh(mesh), _system(assemble(mesh, Minus::values)), _size(_system.contacts + 1) {
    couple();
    factorise(ordering);
    condense_displacement();
    require(VecCreateSeq(PETSC_COMM_SELF, _system.unknowns, &_load), "VecCreateSeq");
    require(VecDuplicate(_load, &_interior), "VecDuplicate");
  }
  ~SchurPeer() override {
    VecDestroy(&_load);
    VecDestroy(&_interior);
    MatDestroy(&_factor);
    MatDestroy(&_matrix);
  }
  SchurPeer(const SchurPeer&) = delete;
  SchurPeer& operator=(const SchurPeer&) = delete;

  PeerAnswer solve(const std::vector<double>& nodal_force) override {
    const std::vector<double> load = load_vector(_mesh, _system, nodal_force);
    double energy = 0;
    const std::vector<double> g = condensed(load, energy);
    // r = s (1'g) / sigma - g on the contacts.
    const double total = std::accumulate(g.begin(), g.end(), 0.0);
    std::vector<double> r(at(_system.contacts));
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = _row[i] * total / _sigma - g[i];
    const DenseActiveSet::Solution contact = _active_set->solve(r);

    PeerAnswer answer;
    answer.steps = contact.steps;
    answer.displacement = total / _sigma;
    for (std::size_t i = 0; i < r.size(); ++i) {
      answer.displacement += _row[i] * contact.d[i] / _sigma;
    }
    std::vector<double> t(at(_size), answer.displacement);
    for (std::size_t i = 0; i < r.size(); ++i) t[i] -= contact.d[i];
    for (std::size_t j = 0; j < t.size(); ++j) {
      double force = 0;
      for (std::size_t i = 0; i < t.size(); ++i) force += _schur[j * t.size() + i] * t[i];
      energy += t[j] * (0.5 * force - g[j]);
    }
    answer.energy = energy;
    return answer;
  }

 private:
  struct Entry {
    std::size_t interior, trace;
    double value;
  };

  /// K_IG as a list: it is short.
  void couple() {
    for (std::int32_t i = 0; i < _system.interior(); ++i) {
      for (std::int32_t k = _system.first[at(i)]; k < _system.first[at(i) + 1]; ++k) {
        const std::int32_t column = _system.column[at(k)];
        if (column < _system.interior()) continue;
        _coupling.push_back({at(i), at(column - _system.interior()), _system.value[at(k)]});
      }
    }
  }

  void factorise(int ordering) {
    _matrix = symmetric_matrix(_system);
    require(MatSetOption(_matrix, MAT_SPD, PETSC_TRUE), "MatSetOption");
    require(MatGetFactor(_matrix, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &_factor), "MatGetFactor");
    // Before the analysis MUMPS hears of options of the database only.
    require(PetscOptionsSetValue(nullptr, "-mat_mumps_icntl_7", std::to_string(ordering).c_str()),
            "ICNTL(7)");
    IS trace = nullptr;
    require(ISCreateStride(PETSC_COMM_SELF, _size, _system.interior(), 1, &trace), "ISCreate");
    require(MatFactorSetSchurIS(_factor, trace), "MatFactorSetSchurIS");
    require(MatCholeskyFactorSymbolic(_factor, _matrix, nullptr, nullptr), "the analysis");
    require(MatCholeskyFactorNumeric(_factor, _matrix, nullptr), "the factorisation");
    ISDestroy(&trace);
    // Solve with the interior alone.
    require(MatMumpsSetIcntl(_factor, 26, 0), "ICNTL(26)");
    Mat schur = nullptr;
    require(MatFactorCreateSchurComplement(_factor, &schur, nullptr), "the Schur complement");
    const double* values = nullptr;
    require(MatDenseGetArrayRead(schur, &values), "MatDenseGetArrayRead");
    _schur.assign(values, values + at(_size) * at(_size));
    MatDenseRestoreArrayRead(schur, &values);
    MatDestroy(&schur);
  }

  void condense_displacement() {
    const std::size_t n = at(_size), c = n - 1;
    std::vector<double> row(n, 0.0);  // S times the vector of ones
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i < n; ++i) row[i] += _schur[j * n + i];
    }
    _sigma = std::accumulate(row.begin(), row.end(), 0.0);
    std::vector<double> matrix(c * c);
    for (std::size_t j = 0; j < c; ++j) {
      for (std::size_t i = 0; i < c; ++i) {
        matrix[j * c + i] = _schur[j * n + i] - row[i] * row[j] / _sigma;
      }
    }
    row.pop_back();
    _row = std::move(row);
    _active_set.emplace(_system.contacts, std::move(matrix));
  }

  /// f_G - K_GI K_II^-1 f_I; adds -f_I'K_II^-1 f_I / 2 to the energy.
  std::vector<double> condensed(const std::vector<double>& load, double& energy) {
    const std::size_t interior = at(_system.interior());
    double* to = nullptr;
    require(VecGetArrayWrite(_load, &to), "VecGetArrayWrite");
    std::copy(load.begin(), load.end(), to);
    VecRestoreArrayWrite(_load, &to);
    require(MatSolve(_factor, _load, _interior), "MatSolve");
    const double* x = nullptr;
    require(VecGetArrayRead(_interior, &x), "VecGetArrayRead");
    std::vector<double> g(load.begin() + _system.interior(), load.end());
    for (const Entry& entry : _coupling) g[entry.trace] -= entry.value * x[entry.interior];
    for (std::size_t i = 0; i < interior; ++i) energy -= 0.5 * load[i] * x[i];
    VecRestoreArrayRead(_interior, &x);
    return g;
  }

  const PlainMesh& _mesh;
  Monolithic _system;
  PetscInt _size;  // of S: contacts, then A
  std::vector<Entry> _coupling;
  Mat _matrix = nullptr, _factor = nullptr;
  Vec _load = nullptr, _interior = nullptr;
  std::vector<double> _schur;
  std::vector<double> _row;  // s: S 1 on the contacts
  double _sigma = 0;         // 1'S 1
  std::optional<DenseActiveSet> _active_set;
};

}  // namespace

Mat symmetric_matrix(Monolithic& system) {
  Mat matrix = nullptr;
  require(MatCreateSeqSBAIJWithArrays(PETSC_COMM_SELF, 1, system.unknowns, system.unknowns,
                                      system.first.data(), system.column.data(),
                                      system.value.data(), &matrix),
          "MatCreateSeqSBAIJWithArrays");
  return matrix;
}

std::unique_ptr<Peer> schur_peer(const PlainMesh& mesh, int ordering) {
  return std::make_unique<SchurPeer>(mesh, ordering);
}

}  // namespace anticrack::benchmarks

// SPDX-License-Identifier: GPL-3.0-or-later
//
// Everything that is kept of a mesh between load cases, behind plain types: the layers above see
// neither Eigen nor CHOLMOD.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

#include "contact/answer.hpp"
#include "contact/sweep_columns.hpp"
#include "errors/errors.hpp"
#include "fem/load.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::operators {

class PreparedLoad;
class LoadBasis;
class UzawaBlock;

/// Factorised subdomains, Schur complements, the skeleton condensed to the cracks and interface
/// mass of one mesh; what Algorithm 2 alone needs, and condensed bases of sweeps, from when they
/// are first asked for. Any number of threads may solve on it at once, with the same answers
/// whatever else was asked.
class MeshOperator : public std::enable_shared_from_this<MeshOperator> {
 public:
  /// Factorises every subdomain (paper: the matrices of Algorithm 2), two at a time where
  /// `threads` allows. Throws errors::Error: numerical (a part that nothing or
  /// contact alone holds), cancelled. Cost: one sparse Cholesky per subdomain plus O(n_G^3) on the
  /// interface nodes.
  static std::shared_ptr<const MeshOperator> factorise(std::shared_ptr<const mesh::Mesh> mesh,
                                                       int threads, std::stop_token stop);
  ~MeshOperator();

  /// One load case. O(n_G^2) an iteration of Algorithm 2, O(c^3) a step of the active set with c
  /// crack nodes, O(N) before and (for fields) after.
  /// Same mesh, load and options: same bits. Throws errors::Error (expression_invalid: a value that
  /// is not finite, with the place; invalid_argument: a subdomain or inclusion the mesh does not
  /// have, an array of another length, a point outside; not_implemented: Uzawa where
  /// ddm::uzawa_obstacle has a reason; cancelled: `stop` was requested while the load was
  /// integrated, before there is an iteration that the observer could stop).
  contact::Answer solve(const fem::Load& load, const contact::SolverOptions& options, bool fields,
                        contact::Observer& observer, const std::stop_token& stop = {}) const;

  /// Condenses several loads with one pass over the factors: forward solves in blocks of columns.
  /// Entry i belongs to loads[i]; what is wrong with one load is its entry (as `solve` throws it)
  /// and no other's. The bits of a load's numbers do not depend on its neighbours.
  std::vector<std::variant<PreparedLoad, errors::Error>> prepare(
      std::span<const fem::Load* const> loads, const std::stop_token& stop = {}) const;

  /// `solve` from a prepared load.
  contact::Answer solve(const PreparedLoad& load, const contact::SolverOptions& options,
                        bool fields, contact::Observer& observer) const;

  /// Fills the fields of answers that `solve` gave without them, answers[i] from loads[i]: backward
  /// solves in blocks of columns, the same bits as one by one. Throws errors::Error (internal) for
  /// loads that have none, limit_exceeded without memory.
  void recover_fields(std::span<const PreparedLoad* const> loads,
                      std::span<contact::Answer* const> answers) const;

  /// Condenses loads whose combinations are to be solved: O(N) each and O(n_G^2 + N m) for what
  /// pairs of them say of the energy; N m numbers meanwhile. The last few bases are kept
  /// (BasisCache): loads that are the same but for their names, arrays by the hash of their upload,
  /// are condensed once, also where several threads ask at once. Throws errors::Error as `solve`
  /// does, with "load_cases[j]." before the path of the field; limit_exceeded where the loads take
  /// more memory than max_basis_bytes together.
  std::shared_ptr<const LoadBasis> basis(std::span<const fem::Load* const> loads,
                                         const std::stop_token& stop = {}) const;

  /// Rows `first` to first + rows.size() of a sweep, row k the load sum_j c_kj f_j, coefficients
  /// (rows, loads) row-major. Each starts from the contact of the one before, the first from that
  /// of `start` (empty: all closed), which becomes the last one's; the numbers do not depend on it
  /// (DenseLcp). O(m c) and a few steps of O(c^3) or less a row, no allocation in a row whose
  /// contact is near that of the one before. What the numbers of a row are and when it is
  /// not_converged: contact::SweepSolver.
  /// `rows` has its width from mesh() and contact_nodes(). Throws errors::Error (internal) for
  /// another shape, and for a basis of another mesh.
  /// Returns false where `stop` was requested between two rows.
  bool sweep(const LoadBasis& basis, std::span<const double> coefficients,
             const contact::ActiveSetOptions& options, contact::SweepColumns& rows,
             std::vector<char>& start, const std::stop_token& stop = {}) const;
  /// The same for loads prepared one by one.
  bool sweep(std::span<const PreparedLoad> loads, const contact::ActiveSetOptions& options,
             contact::SweepColumns& rows, std::vector<char>& start,
             const std::stop_token& stop = {}) const;
  /// A row as a load of its own, for its traces; not for fields, which solve() refuses then
  /// (internal). O((trace + Dirichlet nodes) m).
  PreparedLoad combine(const LoadBasis& basis, std::span<const double> coefficients) const;

  /// Contacts of the sweeps' rows: interface, and index of the node in its trace_geometry(), for
  /// every node there that may open (one where interfaces cross is there once on each).
  const std::vector<std::array<std::int32_t, 2>>& contact_nodes() const noexcept;

  /// Why Algorithm 2 does not apply to this mesh; empty where it does.
  const std::string& uzawa_obstacle() const noexcept;

  const mesh::Mesh& mesh() const noexcept;
  /// Per interface of the mesh.
  const std::vector<contact::TraceGeometry>& trace_geometry() const noexcept;
  /// Triangles of a subdomain, (m_i,3) row-major, as indices into Field::nodes of its answers: with
  /// two sides of a slit in one subdomain a mesh node is there twice, once a side.
  const std::vector<std::int32_t>& field_triangles(std::size_t subdomain) const;
  /// Memory held now, measured, bytes (the mesh included).
  std::size_t bytes() const noexcept;
  /// theta* for lumped mass; 0 where Algorithm 2 does not apply. Computed when it is first asked
  /// for, here or by Algorithm 2: O(n_G^3), at a large interface more than all else. Throws
  /// errors::Error (numerical) when it cannot be computed.
  double theta_star() const;
  /// The same where it is known already, else 0. Does not wait.
  double known_theta_star() const noexcept;

 private:
  friend class UzawaBlock;
  struct Parts;
  explicit MeshOperator(std::unique_ptr<const Parts> parts);
  /// Throws errors::Error (internal) unless the load is of this mesh, and has fields if asked for.
  void require_prepared(const PreparedLoad& load, bool fields) const;
  void require_shape(const contact::SweepColumns& rows, std::span<const char> start) const;
  std::unique_ptr<const Parts> _parts;
};

/// A load condensed on one mesh. Keeps the mesh's operators alive.
class PreparedLoad {
 public:
  PreparedLoad(PreparedLoad&&) noexcept;
  PreparedLoad& operator=(PreparedLoad&&) noexcept;
  ~PreparedLoad();

 private:
  friend class MeshOperator;
  friend class UzawaBlock;
  struct Data;
  explicit PreparedLoad(std::unique_ptr<Data> data);
  std::unique_ptr<Data> _data;
};

/// Loads f_1 ... f_m of one mesh, condensed. Immutable: any number of threads may sweep over it at
/// once. Keeps the mesh's operators alive.
class LoadBasis {
 public:
  ~LoadBasis();
  std::size_t size() const noexcept;   ///< m
  std::size_t bytes() const noexcept;  ///< memory held
  /// Of all of them, as they stand in an answer.
  const std::vector<std::string>& warnings() const noexcept;

 private:
  friend class MeshOperator;
  struct Data;
  explicit LoadBasis(std::unique_ptr<const Data> data);
  std::unique_ptr<const Data> _data;
};

/// Load cases of one mesh that iterate Algorithm 2 together, one column each: a matrix product
/// where each alone would cost matrix-vector products. Columns join and leave between two
/// iterations; each has its own theta, p, stopping rule and observer. The numbers of a column do
/// not depend on the others beyond rounding (1e-12 of a converged answer). One object belongs to
/// one thread at a time.
class UzawaBlock {
 public:
  /// Throws errors::Error (not_implemented) where Algorithm 2 does not apply to the mesh.
  UzawaBlock(std::shared_ptr<const MeshOperator> mesh_operator, contact::Mass mass, int capacity);
  ~UzawaBlock();
  UzawaBlock(const UzawaBlock&) = delete;
  UzawaBlock& operator=(const UzawaBlock&) = delete;

  int columns() const noexcept;   ///< under way
  int capacity() const noexcept;  ///< columns that may be under way at once

  /// The place of the column, below capacity(), until it has ended. `options.mass` is the block's.
  /// The observer outlives the column.
  int add(PreparedLoad load, const contact::UzawaOptions& options, bool fields,
          contact::Observer& observer);
  /// One iteration of every column: O(n_G^2 columns) as one product, no allocation. Each observer
  /// hears of its column; one that says no ends it as cancelled.
  void step();

  struct Ended {
    int place = 0;
    contact::Answer answer;
  };
  /// The columns that ended in the last step, in the order of their places, which are free now. May
  /// cost a backward solve each (traces, fields).
  std::vector<Ended> take_ended();

 private:
  struct State;
  std::unique_ptr<State> _state;
};

/// Of the condensed loads of a basis while it is made.
constexpr std::size_t max_basis_bytes = std::size_t{4} << 30;

/// Upper estimate of bytes() before factorising, cached bases apart. O(m).
std::size_t estimate_bytes(const mesh::Mesh& mesh);

/// Throws errors::Error (internal) unless BLAS is the pthread build of OpenBLAS, and sets it to one
/// thread: the serial build gave 40 wrong factors of 44 under threads, silently.
void require_threadsafe_blas();

}  // namespace anticrack::operators

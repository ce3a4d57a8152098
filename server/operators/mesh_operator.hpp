// SPDX-License-Identifier: GPL-3.0-or-later
//
// Everything of a mesh that is kept between load cases, behind plain types: the layers above see
// neither Eigen nor CHOLMOD.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "errors/errors.hpp"
#include "fem/load.hpp"
#include "mesh/mesh.hpp"

namespace anticrack::contact {
struct ActiveSetOptions;
struct Answer;
class Observer;
class OpenResponses;
struct SweepColumns;
struct TraceGeometry;
}  // namespace anticrack::contact

namespace anticrack::operators {

class Growth;
struct PointPlace;
class PreparedLoad;
class LoadBasis;
class UzawaBlock;

/// Nodes of the interfaces up to which a membrane is condensed to them, with dense matrices.
constexpr std::size_t default_condensed_up_to = 3000;

/// Factorised subdomains, Schur complements, the skeleton condensed to the cracks and the interface
/// mass of one mesh; on demand also the flexibilities and theta* of Algorithm 2, and bases of
/// sweeps. Thread-safe; the answer to a call does not depend on other calls.
class MeshOperator : public std::enable_shared_from_this<MeshOperator> {
 public:
  /// Factorises every subdomain (paper: the matrices of Algorithm 2) on `threads` threads. Throws
  /// errors::Error: numerical (a part that nothing or contact alone holds), cancelled. One sparse
  /// Cholesky factorisation per subdomain plus O(n_G^3) for n_G interface nodes. Of more than
  /// `condensed_up_to` the membrane is joined instead: one sparse factor, O(N^1.5), with a dense
  /// matrix for up to contact::most_dense_contacts contacts, O(c^3); 0: no dense matrix at all.
  static std::shared_ptr<const MeshOperator> factorise(
      std::shared_ptr<const mesh::Mesh> mesh, int threads, std::stop_token stop,
      std::size_t condensed_up_to = default_condensed_up_to);
  /// Condenses loads by forward solves in blocks of columns, O(N) each. Entry i belongs to loads[i]
  /// and holds its error: expression_invalid (a value that is not finite, with the place),
  /// invalid_argument (an unknown subdomain or inclusion, an array of another length, a point
  /// outside), cancelled (`stop`). The bits of a load do not depend on the others.
  std::vector<std::variant<PreparedLoad, errors::Error>> prepare(
      std::span<const fem::Load* const> loads, const std::stop_token& stop = {}) const;

  /// Solves the exact contact problem; UzawaBlock is for Algorithm 2. O(c^3) for each step of the
  /// active set with c crack nodes, and O(N) for fields. Same mesh, load and options: same bits.
  contact::Answer solve(const PreparedLoad& load, const contact::ActiveSetOptions& options,
                        bool fields, contact::Observer& observer) const;

  /// Fills the fields of answers[i] to loads[i] by backward solves in blocks of columns, with the
  /// bits of single solves. Throws errors::Error: internal for combinations, limit_exceeded without
  /// memory.
  void recover_fields(std::span<const PreparedLoad* const> loads,
                      std::span<contact::Answer* const> answers) const;

  /// Fills the bounds of an answer to this load (energy_lower, ..., those of its inclusions; or
  /// no_bracket). Returns the error indicator of each triangle of the mesh, shape (m): int |sigma -
  /// T grad u_h|^2 / T + 2 int p [u_h] over its minus faces; their sum is at least |u - u_h|^2 in
  /// the energy norm. Returns an empty vector if there is no bracket. If the answer has no fields,
  /// they are recovered and dropped again. O(N), and a few solves for the bounds of each inclusion.
  /// Throws errors::Error (cancelled).
  std::vector<double> estimate(const PreparedLoad& load, contact::Answer& answer,
                               const std::stop_token& stop = {}) const;
  struct Estimate {
    const PreparedLoad* load;
    contact::Answer* answer;
    std::stop_token stop;
    bool closely = false;  ///< spend more on closer bounds of A, as for an accuracy of it
    /// If given, the indicator has the parts of the triangles in the half widths of the bounds of
    /// A, each over |A|; or, if true, over the largest |A|. Without such bounds it is as above.
    std::optional<bool> of_largest{};
    bool keep_flux = false;
    std::vector<double> indicator{};
    /// If it is to be kept and there are bounds: the flux of sigma out of each triangle of the mesh
    /// through the side opposite to each corner, shape (m,3). A row sums to -int f.
    std::vector<double> balanced_flux{};
    std::exception_ptr failure{};
    bool of_energy = false;  ///< there are no bounds of A
  };
  /// The same for several answers at once, which is faster; the bits of each are as if it were
  /// alone. An error of one is stored as its `failure`.
  void estimate(std::span<Estimate> all) const;
  /// Makes what the first call of find_boundary() and of estimate() makes of the mesh, so that one
  /// thread may do it while another solves. O(m log m). Throws errors::Error (cancelled).
  void make_ready_for_bounds() const;
  /// How many answers to estimate together: as many as gain speed and fit in memory.
  std::size_t estimated_together() const noexcept;

  /// The rows of BoundaryForces. O(m) in the first call.
  std::size_t boundary_count() const;
  /// Fills the forces on the parts of the boundary of an answer with fields to this load; of a row
  /// of a sweep there are none. O(boundary).
  void find_boundary(const PreparedLoad& load, contact::Answer& answer) const;
  /// Where points lie. O(m log k + hits) for k points.
  std::vector<PointPlace> find_points(std::span<const mesh::Point> points) const;
  /// u of an answer with fields at such a point, on the minus and the plus side of the interface on
  /// which it lies; elsewhere both are one.
  std::pair<double, double> u_at(const PointPlace& place, const mesh::Point& point,
                                 const contact::Answer& answer) const;
  /// The tips of cracks and inclusions: mesh::tips. O(m log m) in the first call.
  std::size_t tip_count() const;
  /// Fills the tips of an answer to this load (contact::TipAnswer), for which it recovers the
  /// fields if it has none, and drops them again. O(triangles near tips), and O(m) for the load.
  /// Throws errors::Error (cancelled, limit_exceeded without memory).
  void find_tips(const PreparedLoad& load, contact::Answer& answer,
                 const std::stop_token& stop = {}) const;

  /// Condenses m loads to be combined: O(N) each and O(n_G^2 + N m) for the energy of pairs; takes
  /// memory for N m numbers meanwhile. The basis is cached (BasisCache): loads that differ in their
  /// names only are condensed once; arrays are compared by the hash of their upload. Throws errors
  /// of loads as in prepare(), with "load_cases[j]." before the field, and limit_exceeded beyond
  /// max_basis_bytes. `bounds`: also keeps what fields and bounds of combinations need, O(N)
  /// numbers a load, and, if `rows` rows share bounds, what sweep() bounds them by. `tips`: what
  /// the numbers of tips need.
  std::shared_ptr<const LoadBasis> basis(std::span<const fem::Load* const> loads,
                                         const std::stop_token& stop = {}, bool bounds = false,
                                         std::uint64_t rows = 0, bool tips = false) const;
  /// Whether so many rows of combinations of so many loads share bounds (shared_bounds.hpp).
  bool shares_bounds(std::size_t loads, std::uint64_t rows) const;

  /// Solves the rows of a sweep, row k for the load sum_j c_kj f_j; coefficients have shape (rows,
  /// loads), row-major. Rows are solved in the order of contact::solving_order. Each starts from
  /// the contact of the one before, the first from `start` (empty: all closed), which is set to the
  /// contact of the last; no number but the steps depends on either. If the basis was made for rows
  /// that share bounds, and `rows` has columns for them, they are filled in; a row without, NaN,
  /// has to be estimated as a load of its own.
  /// A row costs O(m c) and a few steps of at most O(c^3), and allocates nothing if the contact
  /// changes little; see contact::SweepSolver for the numbers and not_converged. The width of
  /// `rows` must fit mesh() and contact_nodes(). Throws errors::Error (internal) for another shape
  /// or a basis of another mesh. Returns false if `stop` was requested between rows.
  bool sweep(const LoadBasis& basis, std::span<const double> coefficients,
             const contact::ActiveSetOptions& options, contact::SweepColumns& rows,
             std::vector<char>& start, const std::stop_token& stop = {}) const;
  /// The same for loads prepared one by one.
  bool sweep(std::span<const PreparedLoad> loads, const contact::ActiveSetOptions& options,
             contact::SweepColumns& rows, std::vector<char>& start,
             const std::stop_token& stop = {}) const;
  /// The load of a row, to solve for traces; its answers have fields and bounds only if the basis
  /// was made with `bounds`. O((trace + Dirichlet nodes) m), with bounds O(N m).
  PreparedLoad combine(const LoadBasis& basis, std::span<const double> coefficients) const;

  /// (interface, index in its trace_geometry()) of each node that may open, the columns of
  /// SweepColumns:: contact; a node where interfaces cross appears once for each.
  const std::vector<std::array<std::int32_t, 2>>& contact_nodes() const noexcept;

  /// The reason why Algorithm 2 does not apply to this mesh; empty if it applies.
  const std::string& uzawa_obstacle() const noexcept;

  const mesh::Mesh& mesh() const noexcept;
  /// The positions of the trace nodes, per interface of the mesh.
  const std::vector<contact::TraceGeometry>& trace_geometry() const noexcept;
  /// The nodes of a subdomain, which are Field::nodes in every answer; a node with two sides (slit)
  /// occurs twice.
  const std::vector<std::int32_t>& field_nodes(std::size_t subdomain) const;
  /// Triangles of a subdomain, (m_i,3) row-major, as indices into field_nodes.
  const std::vector<std::int32_t>& field_triangles(std::size_t subdomain) const;
  /// Means of Txx, Txy, Tyy over these triangles, (m_i,3) row-major.
  std::vector<double> field_tension(std::size_t subdomain) const;
  /// The memory held now, measured, in bytes, including the mesh and the bounds being computed.
  std::size_t bytes() const noexcept;
  /// theta* for lumped mass; 0 if Algorithm 2 does not apply. Computed at the first use: O(n_G^3).
  /// Throws errors::Error (numerical) when it cannot be computed.
  double theta_star() const;

  struct Parts;

 private:
  friend class Growth;
  friend class UzawaBlock;
  explicit MeshOperator(std::shared_ptr<const Parts> parts) : _parts(std::move(parts)) {}
  /// Throws errors::Error (internal) if the load is of another mesh, or if `fields` are asked for
  /// and it cannot have them.
  void require_prepared(const PreparedLoad& load, bool fields) const;
  /// Calls solve_row(solver, row) for each row. Throws errors::Error (internal) for another shape.
  template <class SolveRow>
  bool sweep_rows(const contact::ActiveSetOptions& options, contact::SweepColumns& rows,
                  std::vector<char>& start, const std::stop_token& stop,
                  std::span<const std::size_t> order, contact::OpenResponses* responses,
                  const SolveRow& solve_row) const;
  std::shared_ptr<const Parts> _parts;
};

/// A load condensed on one mesh. Keeps the operators of the mesh alive.
class PreparedLoad {
 public:
  struct Data;
  explicit PreparedLoad(std::shared_ptr<const Data> data) : _data(std::move(data)) {}

 private:
  friend class Growth;
  friend class MeshOperator;
  friend class UzawaBlock;
  std::shared_ptr<const Data> _data;
};

/// Condensed loads f_1 ... f_m of one mesh, whose operators it keeps alive. Immutable, thread-safe.
class LoadBasis {
 public:
  struct Data;
  explicit LoadBasis(std::shared_ptr<const Data> data) : _data(std::move(data)) {}

  std::size_t size() const noexcept;   ///< m
  std::size_t bytes() const noexcept;  ///< memory held, in bytes
  /// The warnings of all loads, as they stand in an answer.
  const std::vector<std::string>& warnings() const noexcept;

 private:
  friend class MeshOperator;
  std::shared_ptr<const Data> _data;
};

/// Most memory of the condensed loads of a basis while it is made.
constexpr std::size_t max_basis_bytes = std::size_t{4} << 30;

/// Upper estimate of bytes() before factorising, cached bases apart. O(m).
std::size_t estimate_bytes(const mesh::Mesh& mesh);

/// Calls ddm::require_threadsafe_blas(): throws errors::Error (internal) if BLAS is unsafe.
void require_threadsafe_blas();

}  // namespace anticrack::operators

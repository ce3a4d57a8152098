// SPDX-License-Identifier: GPL-3.0-or-later
#include "contact/contact_blocks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/at.hpp"
#include "base/at_once.hpp"
#include "base/union_find.hpp"
#include "ddm/elimination_order.hpp"
#include "ddm/subdomain_factor.hpp"

namespace anticrack::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;
using Indices = std::vector<std::int32_t>;

/// How far the membrane around a block reaches, as a fraction of the length of its box.
constexpr double reach = 0.2;

struct Partition {
  std::vector<Indices> blocks;
  std::vector<Eigen::Triplet<double>> hats;
  Index hat_count = 0;
};

/// Adds hats, whose tops are in the middles of a crack's blocks and where two blocks meet.
void add_hats(const Indices& chain, std::size_t each, Partition& partition) {
  const double half = static_cast<double>(each) / 2;
  const auto count =
      static_cast<Index>(std::ceil(static_cast<double>(chain.size() + 1) / half)) - 1;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const double place = static_cast<double>(i + 1) / half;  // hat k has its top at k + 1
    const auto left = static_cast<Index>(std::floor(place)) - 1;
    const double right_part = place - std::floor(place);
    if (left >= 0 && left < count)
      partition.hats.emplace_back(chain[i], partition.hat_count + left, 1 - right_part);
    if (left + 1 < count && right_part > 0)
      partition.hats.emplace_back(chain[i], partition.hat_count + left + 1, right_part);
  }
  partition.hat_count += count;
}

/// Divides the contacts into blocks; a dependent contact is in the block of those it depends on.
Partition part(const TraceProblem& traces) {
  Partition result;
  std::vector<Indices> pieces;
  for (const Indices& chain : traces.chains()) {
    const std::size_t count = (chain.size() + most_of_a_block - 1) / most_of_a_block;
    const std::size_t each = (chain.size() + count - 1) / count;
    for (std::size_t first = 0; first < chain.size(); first += each)
      pieces.emplace_back(
          chain.begin() + static_cast<std::ptrdiff_t>(first),
          chain.begin() + static_cast<std::ptrdiff_t>(std::min(first + each, chain.size())));
    if (count > 1) add_hats(chain, each, result);
  }
  const ddm::Skeleton& skeleton = traces.decomposition().skeleton;
  Indices piece_of(skeleton.independent, -1);
  for (std::size_t k = 0; k < pieces.size(); ++k)
    for (const std::int32_t contact : pieces[k])
      piece_of[at(contact)] = static_cast<std::int32_t>(k);
  base::UnionFind joined(pieces.size());
  for (const ddm::Terms& row : skeleton.dependent)
    for (const ddm::Term& term : row)
      joined.unite(piece_of[at(row.front().index)], piece_of[at(term.index)]);
  std::vector<Indices> merged(pieces.size());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    Indices& into = merged[at(joined.find(static_cast<std::int32_t>(k)))];
    into.insert(into.end(), pieces[k].begin(), pieces[k].end());
  }
  for (Indices& block : merged) {
    if (block.empty()) continue;
    std::ranges::sort(block);
    result.blocks.push_back(std::move(block));
  }
  return result;
}

/// Entries of x by their abscissae, to find those in a box.
class Places {
 public:
  explicit Places(const JoinedMembrane& membrane) : _xy(membrane.places()) {
    _by_x.reserve(at(membrane.size()));
    for (std::int32_t i = 0; i < membrane.size(); ++i) _by_x.push_back({of(i)[0], of(i)[1], i});
    std::ranges::sort(_by_x, {}, &Place::x);
  }
  /// Entries whose places lie in the box, ascending.
  Indices in_box(const std::array<double, 2>& low, const std::array<double, 2>& high) const {
    Indices found;
    auto one = std::ranges::lower_bound(_by_x, low[0], {}, &Place::x);
    for (; one != _by_x.end() && one->x <= high[0]; ++one)
      if (one->y >= low[1] && one->y <= high[1]) found.push_back(one->entry);
    std::ranges::sort(found);
    return found;
  }
  const double* of(std::int32_t i) const { return &_xy[2 * at(i)]; }

 private:
  struct Place {
    double x, y;
    std::int32_t entry;
  };

  const std::vector<double>& _xy;
  std::vector<Place> _by_x;
};

/// The membrane around one block. For one thread.
class Patch {
 public:
  Patch(const JoinedMembrane& membrane, const Places& places, const Indices& first_motion)
      : _membrane(membrane),
        _places(places),
        _motion(first_motion),
        _local(at(membrane.matrix().rows()), -1) {}

  MatrixXd schur(const Indices& contacts) {
    const Indices inside = nodes_around(contacts);
    const auto interior = static_cast<Index>(inside.size());
    std::vector<double> xy;
    for (std::size_t k = 0; k < inside.size(); ++k) {
      _local[at(inside[k])] = static_cast<std::int32_t>(k);
      xy.insert(xy.end(), _places.of(inside[k]), _places.of(inside[k]) + 2);
    }
    for (std::size_t k = 0; k < contacts.size(); ++k)
      _local[at(contact(contacts[k]))] =
          static_cast<std::int32_t>(interior + static_cast<Index>(k));
    std::vector<Eigen::Triplet<double, std::int32_t>> entries;
    const auto add = [&](std::int32_t column) {
      for (Sparse::InnerIterator entry(_membrane.matrix(), column); entry; ++entry) {
        const std::int32_t i = _local[at(entry.row())], j = _local[at(column)];
        if (i >= 0) entries.emplace_back(std::max(i, j), std::min(i, j), entry.value());
      }
    };
    for (const std::int32_t node : inside) add(node);
    for (const std::int32_t c : contacts) add(static_cast<std::int32_t>(contact(c)));
    for (const std::int32_t node : inside) _local[at(node)] = -1;
    for (const std::int32_t c : contacts) _local[at(contact(c))] = -1;
    const Index all = interior + static_cast<Index>(contacts.size());
    Sparse matrix(all, all);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return ddm::SubdomainFactor(matrix, interior, ddm::elimination_order(matrix, interior, xy))
        .schur();
  }

 private:
  Index contact(std::int32_t c) const { return _membrane.size() + c; }

  /// Visits the entries of x that B couples to a contact.
  template <class Visit>
  void each_neighbour(std::int32_t c, const Visit& visit) const {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator entry(_membrane.coupling(), c);
         entry; ++entry)
      visit(static_cast<std::int32_t>(entry.col()));
  }

  Indices nodes_around(const Indices& contacts) const {
    constexpr double far = std::numeric_limits<double>::infinity();
    std::array<double, 2> low{far, far}, high{-far, -far};
    Indices motions;
    for (const std::int32_t c : contacts) {
      each_neighbour(c, [&](std::int32_t i) {
        if (_motion[at(i)] != 0) {
          motions.push_back(i);
          return;
        }
        for (std::size_t k = 0; k < 2; ++k) {
          low[k] = std::min(low[k], _places.of(i)[k]);
          high[k] = std::max(high[k], _places.of(i)[k]);
        }
      });
    }
    const double grow = reach * std::hypot(high[0] - low[0], high[1] - low[1]);
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] -= grow;
      high[k] += grow;
    }
    Indices found = _places.in_box(low, high);
    std::erase_if(found, [this](std::int32_t i) { return _motion[at(i)] != 0; });
    found.insert(found.end(), motions.begin(), motions.end());
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

  const JoinedMembrane& _membrane;
  const Places& _places;
  const Indices& _motion;  // (x) 1 for a rigid motion
  Indices _local;
};

Indices mark_motions(const JoinedMembrane& membrane) {
  const ddm::Skeleton& skeleton = membrane.decomposition().skeleton;
  Indices result(at(membrane.size()), 0);
  const std::size_t first = result.size() - skeleton.free;
  for (std::size_t i = 0; i < skeleton.unknowns; ++i)
    if (skeleton.inclusion[i] >= 0)
      for (const ddm::Term& term : skeleton.rows[i].free) result[first + at(term.index)] = 1;
  return result;
}

/// The rows of a block's dependent contacts, in the block's own numbers.
std::vector<ddm::Terms> rows_of(const Indices& contacts, const ddm::Skeleton& skeleton,
                                Indices& conditions) {
  std::vector<ddm::Terms> rows;
  for (std::size_t k = 0; k < skeleton.dependent.size(); ++k) {
    ddm::Terms row;
    for (const auto& [c, factor] : skeleton.dependent[k]) {
      const auto found = std::ranges::lower_bound(contacts, c);
      if (found != contacts.end() && *found == c)
        row.push_back({static_cast<std::int32_t>(found - contacts.begin()), factor});
    }
    if (row.empty()) continue;
    rows.push_back(std::move(row));
    conditions.push_back(static_cast<std::int32_t>(skeleton.independent + k));
  }
  return rows;
}

}  // namespace

ContactBlocks::ContactBlocks(const JoinedMembrane& membrane, const PairForces& forces,
                             int threads) {
  const ddm::Skeleton& skeleton = membrane.decomposition().skeleton;
  const Partition partition = part(membrane.traces());
  const Places places(membrane);
  const Indices motion = mark_motions(membrane);
  std::vector<std::optional<ContactBlock>> done(partition.blocks.size());
  base::at_once(done.size(), threads, [&] {
    return [&, patch = Patch(membrane, places, motion)](std::size_t b) mutable {
      const Indices& contacts = partition.blocks[b];
      Indices conditions = contacts;
      std::vector<ddm::Terms> rows = rows_of(contacts, skeleton, conditions);
      const VectorXd weights = forces.contact_mass()(conditions).cwiseInverse();
      done[b] = ContactBlock{contacts, conditions,
                             DenseLcp(patch.schur(contacts), std::move(rows), weights)};
    };
  });
  _blocks.reserve(done.size());
  for (std::optional<ContactBlock>& block : done) _blocks.push_back(std::move(*block));
  _hats.resize(membrane.contacts(), partition.hat_count);
  _hats.setFromTriplets(partition.hats.begin(), partition.hats.end());
  if (partition.hat_count == 0) return;
  MatrixXd of_hats(membrane.contacts(), partition.hat_count);
  base::at_once(at(partition.hat_count), threads, [&] {
    return [&](std::size_t k) {
      const auto column = static_cast<Index>(k);
      of_hats.col(column) = membrane.apply(VectorXd(_hats.col(column)));
    };
  });
  _coarse_matrix = _hats.transpose() * of_hats;
  _coarse_matrix = (_coarse_matrix + _coarse_matrix.transpose()).eval() / 2;
  _coarse.emplace(_coarse_matrix);
}

std::size_t ContactBlocks::bytes() const noexcept {
  std::size_t bytes = sizeof(double) * at(_coarse_matrix.size()) +
                      at(_hats.nonZeros()) * (sizeof(double) + sizeof(int));
  for (const ContactBlock& block : _blocks)
    bytes += block.lcp.bytes() + block.contacts.capacity() * 2 * sizeof(std::int32_t);
  return bytes + (_coarse ? _coarse->bytes() : 0);
}

}  // namespace anticrack::contact

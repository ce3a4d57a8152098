// SPDX-License-Identifier: GPL-3.0-or-later
//
// The loops of flux_kernels.hpp: include it once in a file compiled for an instruction set, with
// ANTICRACK_FLUX_KERNELS the name of the FluxKernels. It calls no inline function of another
// header, because the linker could use one compiled here in code for every processor.
#include "estimate/flux_kernels.hpp"

namespace anticrack::estimate {
namespace {

/// Fans for which triangles are measured at once.
constexpr std::size_t fans_at_once = 64;
/// So many triangles before it is measured the data of one are fetched: their order is that of
/// fans, not of memory, and waiting for it took a third of the time.
constexpr std::size_t ahead = 16;

template <std::size_t lanes>
struct Wide;
template <>
struct Wide<2> {
  using Number = double __attribute__((vector_size(2 * sizeof(double))));
};
template <>
struct Wide<flux_lanes> {
  using Number = double __attribute__((vector_size(flux_lanes * sizeof(double))));
};

/// The types that hold a number, and a vector, for each lane, and what is done with a vector and an
/// edge, or with both components of a vector.
template <std::size_t lanes>
struct Numbers {
  using Number = typename Wide<lanes>::Number;
  struct Vector {
    Number of[2];
    Vector& operator+=(const Vector& by) {
      of[0] += by.of[0];
      of[1] += by.of[1];
      return *this;
    }
  };
  static Vector vector(const Number& x, const Number& y) { return {{x, y}}; }
  static Vector scaled(const Number& by, const double* edge) {
    return {{by * edge[0], by * edge[1]}};
  }
  static Vector products(const Vector& a, const double* edge) {
    return {{a.of[0] * edge[0], a.of[1] * edge[1]}};
  }
  static Number sum(const Vector& of) { return of.of[0] + of.of[1]; }
  static Number square(const Vector& a) { return a.of[0] * a.of[0] + a.of[1] * a.of[1]; }
};
/// Of one lane and of two the components of a vector are in one register.
template <>
struct Numbers<1> {
  using Number = double;
  using Vector = Wide<2>::Number;
  static Vector vector(Number x, Number y) { return Vector{x, y}; }
  static Vector scaled(Number by, const double* edge) { return Vector{by, by} * loaded(edge); }
  static Vector products(const Vector& a, const double* edge) { return a * loaded(edge); }
  static Number sum(const Vector& of) { return of[0] + of[1]; }
  static Number square(const Vector& a) { return sum(a * a); }
  static Vector loaded(const double* edge) {
    Vector to;
    __builtin_memcpy(&to, edge, sizeof to);
    return to;
  }
};
template <>
struct Numbers<2> {
  using Number = Wide<2>::Number;
  using Vector = Wide<4>::Number;
  static Vector vector(const Number& x, const Number& y) {
    return __builtin_shufflevector(x, y, 0, 1, 2, 3);
  }
  static Vector scaled(const Number& by, const double* edge) {
    return vector(by, by) * loaded(edge);
  }
  static Vector products(const Vector& a, const double* edge) { return a * loaded(edge); }
  static Number sum(const Vector& of) {
    return __builtin_shufflevector(of, of, 0, 1) + __builtin_shufflevector(of, of, 2, 3);
  }
  static Number square(const Vector& a) { return sum(a * a); }

 private:
  static Vector loaded(const double* edge) {
    const Number once = Numbers<1>::loaded(edge);
    return __builtin_shufflevector(once, once, 0, 0, 1, 1);
  }
};

template <std::size_t lanes>
class Flux {
  using Of = Numbers<lanes>;
  using V = typename Of::Number;
  using Pair = typename Of::Vector;

 public:
  Flux(const FluxMesh& mesh, FluxLane* lane, FluxBlock& block, const FluxScratch& scratch)
      : _mesh(mesh),
        _lane(lane),
        _block(block),
        _pressure(lane->most == nullptr),
        _u(reinterpret_cast<const V*>(scratch.u)),
        _mean(reinterpret_cast<Pair*>(scratch.mean)),
        _through(reinterpret_cast<V*>(scratch.through)),
        _x(reinterpret_cast<V*>(scratch.own)),
        _spoke(_x + mesh.largest_fan + 1) {}

  void run(FluxStep step) {
    switch (step) {
      case FluxStep::build:
        if (_lane->force != nullptr)
          build<true>();
        else
          build<false>();
        break;
      case FluxStep::polish:
        polish();
        break;
      case FluxStep::finish:
        finish();
    }
  }

 private:
  template <class Value>
  static V of_lanes(const Value& value) {
    if constexpr (lanes == 1)
      return value(0);
    else if constexpr (lanes == 2)
      return V{value(0), value(1)};
    else
      return V{value(0), value(1), value(2), value(3)};
  }
  static double of(const V& values, std::size_t lane) {
    if constexpr (lanes == 1)
      return values;
    else
      return values[lane];
  }
  static V larger(const V& a, const V& b) { return a < b ? b : a; }
  static V smaller(const V& a, const V& b) { return b < a ? b : a; }

  const V& u(std::int32_t copy) const { return _u[copy]; }
  V force(std::size_t corner) const {
    return of_lanes([&](std::size_t l) { return _lane[l].force[corner]; });
  }

  /// Half the outward flux of T grad u through the sides of a triangle, negative: side i has
  /// -T^2 G.e_i / 2 with G = sum of u_i e_i. Returns |G|^2 T^2.
  V halves(std::size_t t, V* half) const {
    const std::int32_t* const copy = _mesh.copy + 3 * t;
    const double* const edge = _mesh.edge + 6 * t;
    const double tension = _mesh.tension[t], q = tension * tension;
    const V first = u(copy[0]);
    Pair rise = Of::scaled(u(copy[1]) - first, edge + 2);
    rise += Of::scaled(u(copy[2]) - first, edge + 4);
    for (std::size_t i = 0; i < 3; ++i) half[i] = q * Of::sum(Of::products(rise, edge + 2 * i));
    return q * Of::square(rise);
  }

  /// What the fan of corner i of a triangle adds between its spokes, and before the second of them.
  template <bool loaded>
  void spoke_of(const V* half, std::size_t t, std::size_t i, V* to) const {
    to[0] = half[i];
    if constexpr (loaded) to[0] -= force(3 * t + i);
    to[1] = to[0] + half[(i + 1) % 3];
  }

  /// Asks for what measure() needs of a triangle of the block, by its place in FluxMesh::met.
  template <bool loaded>
  void fetch(std::size_t n) const {
    if (n >= _block.last_triangle) return;
    const auto t = static_cast<std::size_t>(_mesh.met[n]);
    __builtin_prefetch(_mesh.edge + 6 * t);
    __builtin_prefetch(_mesh.edge + 6 * t + 5);
    __builtin_prefetch(_mesh.copy + 3 * t);
    __builtin_prefetch(_mesh.tension + t);
    __builtin_prefetch(_mean + t, 1);
    if constexpr (loaded) {
      for (std::size_t l = 0; l < lanes; ++l) {
        __builtin_prefetch(_lane[l].force + 3 * t);
        if (_lane[l].distance != nullptr) __builtin_prefetch(_lane[l].distance + t, 1);
      }
    }
  }

  /// Begins some triangles of the block, in the order of FluxMesh::met: the part of sigma - T grad
  /// u that comes from the load is d/2 (x - centroid) with the divergence d, and the bubble
  ///   b = 1/3 sum_(i<j) (f_j - f_i)(P_j - P_i) l_i l_j,  div b = -(f - mean f),
  /// which has no flux through the sides. With the loads f_i, their sum s and d_i = f_k - f_j this
  /// adds -(f_0 e_2 + f_1 e_0 + f_2 e_1) to the mean, and the square of the rest is
  ///   4 sum_i e_i.e_i (s^2 / 144 + (2 d_i^2 - d_j d_k - s (s - 3 f_i)) / 45).
  template <bool loaded>
  void measure(std::size_t first, std::size_t last) {
    V norm_squared{};
    for (std::size_t n = first; n < last; ++n) {
      look(n);
      const auto t = static_cast<std::size_t>(_mesh.met[n]);
      fetch<loaded>(n + ahead);
      V half[3];
      norm_squared += halves(t, half);
      Pair mean{};
      if constexpr (loaded) {
        const double* const edge = _mesh.edge + 6 * t;
        const V f[3] = {force(3 * t), force(3 * t + 1), force(3 * t + 2)};
        const V d[3] = {f[2] - f[1], f[0] - f[2], f[1] - f[0]};
        const V sum = f[0] + f[1] + f[2];
        mean = Of::vector(d[2] * edge[4] - d[0] * edge[2], d[2] * edge[5] - d[0] * edge[3]);
        V rest{};
        for (std::size_t i = 0; i < 3; ++i) {
          const V bubble =
              2 * d[i] * d[i] - d[(i + 1) % 3] * d[(i + 2) % 3] - sum * (sum - 3 * f[i]);
          const double length = edge[2 * i] * edge[2 * i] + edge[2 * i + 1] * edge[2 * i + 1];
          rest += length * (1.0 / 144 * sum * sum + 1.0 / 45 * bubble);
        }
        for (std::size_t l = 0; l < lanes; ++l)
          if (_lane[l].distance != nullptr) _lane[l].distance[t] = of(4 * rest, l);
      }
      _mean[t] = mean;
      for (std::size_t i = 0; i < 3; ++i)
        spoke_of<loaded>(half, t, i, _spoke + 2 * (3 * (t - _block.first_triangle) + i));
    }
    for (std::size_t l = 0; l < lanes; ++l) _block.norm_squared[l] += of(norm_squared, l);
  }

  /// The fan of corner i adds x out through side j and x' in through side k of the triangle; fans
  /// not yet built count as half of T grad u. With a = x less half of T grad u through side j, this
  /// adds a e_i to the mean of sigma - T grad u, apart from the load. The block without triangles
  /// has fans of other blocks' triangles. Triangles are measured shortly before their first fan, so
  /// that what it needs of them is in the cache.
  template <bool loaded>
  void build() {
    std::size_t met = _block.first_triangle;
    V imbalance{};
    for (std::size_t fan = _block.first_fan; fan < _block.last_fan; ++fan) {
      look(fan);
      if (_block.first_triangle == _block.last_triangle) {
        build_fan<loaded, false, 0>(fan, imbalance);
        continue;
      }
      if ((fan - _block.first_fan) % fans_at_once == 0) {
        const std::size_t end =
            fan + fans_at_once < _block.last_fan ? fan + fans_at_once : _block.last_fan;
        const auto until = static_cast<std::size_t>(_mesh.met_until[end - 1]);
        measure<loaded>(met, until);
        met = until;
      }
      by_size(fan,
              [&](auto size) { build_fan<loaded, true, decltype(size)::corners>(fan, imbalance); });
    }
    measure<loaded>(met, _block.last_triangle);
    for (std::size_t l = 0; l < lanes; ++l) _block.imbalance[l] = of(imbalance, l);
  }

  void polish() {
    for (std::size_t fan = _block.first_fan; fan < _block.last_fan; ++fan) {
      look(fan);
      by_size(fan, [&](auto size) { polish_fan<decltype(size)::corners>(fan); });
    }
  }

  /// So many corners of a fan; 0: any number.
  template <int n>
  struct Size {
    static constexpr int corners = n;
  };
  /// Calls work(Size<n>()). Loops over the usual numbers of corners are unrolled: their means stay
  /// in registers, and no branch depends on the number.
  template <class Work>
  void by_size(std::size_t fan, const Work& work) const {
    switch (_mesh.first_corner[fan + 1] - _mesh.first_corner[fan]) {
      case 4:
        return work(Size<4>());
      case 5:
        return work(Size<5>());
      case 6:
        return work(Size<6>());
      case 7:
        return work(Size<7>());
      case 8:
        return work(Size<8>());
      default:
        return work(Size<0>());
    }
  }

  /// Builds a fan of `n` corners, or of any number if n is 0. `own`: of triangles of the block.
  template <bool loaded, bool own, int n>
  void build_fan(std::size_t fan, V& imbalance) {
    const FanCorner* const around = _mesh.around + _mesh.first_corner[fan];
    const int corners = n > 0 ? n : _mesh.first_corner[fan + 1] - _mesh.first_corner[fan];
    Pair mean[n > 0 ? n : 1], slope[2] = {};
    V x{};
    V* spoke = _x;
    *spoke = x;
#pragma GCC unroll 8
    for (int k = 0; k < corners; ++k) {
      const FanCorner& one = around[k];
      const std::size_t t = static_cast<std::size_t>(one.triangle),
                        i = static_cast<std::size_t>(one.i);
      V computed[2];
      const V* of_triangle = computed;
      if constexpr (own) {
        of_triangle = _spoke + 2 * (3 * (t - _block.first_triangle) + i);
      } else {
        V half[3];
        halves(t, half);
        spoke_of<loaded>(half, t, i, computed);
      }
      Pair now = _mean[t];
      now += Of::scaled(x + of_triangle[1], one.edge);
      slope[k % 2] += Of::products(now, one.edge);
      if constexpr (n > 0)
        mean[k] = now;
      else
        _mean[t] = now;
      x += of_triangle[0];
      *++spoke = x;
    }
    const std::int32_t first_stop = _mesh.first_stop[fan], last_stop = _mesh.first_stop[fan + 1];
    if (first_stop == last_stop) imbalance += larger(x, -x);
    for (std::int32_t s = first_stop; s < last_stop; ++s) {
      const Stop& stop = _mesh.stops[s];
      _through[2 * stop.face + stop.end] = sign(stop) * _x[stop.spoke];
    }
    rotate<n>(fan, slope, mean);
  }

  template <int n>
  void polish_fan(std::size_t fan) {
    const FanCorner* const around = _mesh.around + _mesh.first_corner[fan];
    const int corners = n > 0 ? n : _mesh.first_corner[fan + 1] - _mesh.first_corner[fan];
    Pair mean[n > 0 ? n : 1], slope[2] = {};
#pragma GCC unroll 8
    for (int k = 0; k < corners; ++k) {
      const Pair now = _mean[around[k].triangle];
      slope[k % 2] += Of::products(now, around[k].edge);
      if constexpr (n > 0) mean[k] = now;
    }
    rotate<n>(fan, slope, mean);
  }

  /// Adds the best flux to that through all spokes of a fan, which runs round the node. `slope`:
  /// two parts of its sum over the corners; `mean`: of the n corners, or in memory if n is 0.
  template <int n>
  void rotate(std::size_t fan, const Pair* slope, const Pair* mean) {
    const FanCorner* const around = _mesh.around + _mesh.first_corner[fan];
    const int corners = n > 0 ? n : _mesh.first_corner[fan + 1] - _mesh.first_corner[fan];
    Pair whole = slope[0];
    whole += slope[1];
    const V flux = step(fan, slope_of_work(fan) + Of::sum(whole));
#pragma GCC unroll 8
    for (int k = 0; k < corners; ++k) {
      Pair now = n > 0 ? mean[k] : _mean[around[k].triangle];
      now += Of::scaled(flux, around[k].edge);
      _mean[around[k].triangle] = now;
    }
  }

  void look(std::size_t turn) const {
    if (turn % flux_turn == 0) _mesh.look();
  }

  static double sign(const Stop& stop) { return stop.end == 0 ? -1 : 1; }
  static bool is_minus(const Face& face) {
    return face.condition == Condition::pressed || face.condition == Condition::crack_minus;
  }

  /// The copy at an end of a face.
  std::int32_t at_end(const Face& face, std::int32_t end) const {
    return _mesh.copy[face.side - face.side % 3 + (face.side % 3 + 1 + end) % 3];
  }
  V jump(const Face& face, std::int32_t end) const {
    return u(at_end(_mesh.face[face.other], 1 - end)) - u(at_end(face, end));
  }

  /// Derivative of int p [u] with respect to the flux through the fan's spokes.
  V slope_of_work(std::size_t fan) const {
    V slope{};
    if (!_pressure) return slope;
    for (std::int32_t s = _mesh.first_stop[fan]; s < _mesh.first_stop[fan + 1]; ++s) {
      const Stop& stop = _mesh.stops[s];
      const Face& face = _mesh.face[stop.face];
      if (is_minus(face)) slope -= 0.5 * sign(stop) * (jump(face, 0) + jump(face, 1));
    }
    return slope;
  }

  /// Changes the flux through the fan's spokes to the least allowed distance; returns the change.
  V step(std::size_t fan, const V& slope) {
    const V best = -slope * _mesh.softness[fan];
    const std::int32_t first = _mesh.first_stop[fan], last = _mesh.first_stop[fan + 1];
    if (first == last) return best;
    const V change = allowed(first, last, best);
    for (std::int32_t s = first; s < last; ++s) {
      const Stop& stop = _mesh.stops[s];
      _through[2 * stop.face + stop.end] += sign(stop) * change;
    }
    return change;
  }

  /// The change nearest to `best` with which all faces of the fan stay within their bounds.
  V allowed(std::int32_t first, std::int32_t last, const V& best) const {
    V low = V{} - __builtin_inf(), high = V{} + __builtin_inf();
    for (std::int32_t s = first; s < last; ++s) {
      const Stop& stop = _mesh.stops[s];
      const Face& face = _mesh.face[stop.face];
      const std::int32_t place = 2 * stop.face + stop.end;
      V least = V{} - __builtin_inf(), most{};
      if (face.condition == Condition::given) {
        if (face.traction >= 0)
          most = of_lanes([&](std::size_t l) {
            const double* const traction = _lane[l].traction;
            return traction == nullptr ? 0 : traction[2 * face.traction + stop.end];
          });
        least = most;
      } else if (is_minus(face)) {
        if (!_pressure) {
          most = of_lanes([&](std::size_t l) { return _lane[l].most[place]; });
          least = of_lanes([&](std::size_t l) { return _lane[l].least[place]; });
        }
      } else {
        continue;
      }
      const V now = _through[place];
      if (stop.end == 0) {  // w = -x
        low = larger(low, now - most);
        high = smaller(high, now - least);
      } else {
        low = larger(low, least - now);
        high = smaller(high, most - now);
      }
    }
    const V within = smaller(larger(best, low), high);
    return low > high ? 0.5 * (low + high) : within;  // only by rounding
  }

  void finish() {
    const bool loaded = _lane->force != nullptr;
    for (std::size_t t = _block.first_triangle; t < _block.last_triangle; ++t) {
      look(t);
      const V square = Of::square(_mean[t]);
      for (std::size_t l = 0; l < lanes; ++l) {
        double* const distance = _lane[l].distance;
        if (distance != nullptr) distance[t] = loaded ? of(square, l) + distance[t] : of(square, l);
      }
    }
  }

  const FluxMesh& _mesh;
  FluxLane* const _lane;
  FluxBlock& _block;
  const bool _pressure;
  const V* const _u;
  Pair* const _mean;
  V* const _through;
  V* const _x;      // fluxes through the spokes of a fan
  V* const _spoke;  // of the block's triangles
};

template <std::size_t lanes>
void balance(const FluxMesh& mesh, FluxLane* lane, FluxStep step, FluxBlock& block,
             const FluxScratch& scratch) {
  Flux<lanes>(mesh, lane, block, scratch).run(step);
}

}  // namespace

extern const FluxKernels ANTICRACK_FLUX_KERNELS{balance<1>, balance<2>, balance<flux_lanes>};

}  // namespace anticrack::estimate

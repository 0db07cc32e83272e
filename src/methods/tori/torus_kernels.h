#pragma once
// The blend of tori.h over all tori near a place at once, by the widest instructions the processor
// has. Which ones changes nothing in the results.

#include "methods/tori/slope.h"

namespace littoral {

constexpr int blended_tori = 12;  // that have a say at a place
constexpr int torus_lanes = blended_tori;
constexpr double blend_sharpness = 8;  // decay of weights over one spacing
constexpr double blend_floor = 1e-7;   // weight of the last of them

/// What is asked of a torus, in single or double precision S.
template <class S>
struct TorusRecord {
  double p[3];            // its point
  S q[3], n[3], e1[3];    // q from p; as in Torus
  S k1, k2, rho, weight;  // weight = e^log_weight
};

/// Tori by lanes, and a place as they see it: the nearest first; unused lanes repeat it.
template <class S>
struct TorusLanes {
  alignas(64) S x[3][torus_lanes];  // the place from q
  S n[3][torus_lanes], e1[3][torus_lanes];
  S k1[torus_lanes], k2[torus_lanes], rho[torus_lanes], weight[torus_lanes];
  S squared[torus_lanes];  // distance of the place from the torus' point
  S excess[torus_lanes];   // that minus the nearest one's
  S used[torus_lanes];     // 1 or 0
};

/// The place from the torus' points, by lanes: half the derivative of `squared`.
template <class S>
struct TorusAway {
  alignas(64) S x[3][torus_lanes];
};

/// T: S, or with its gradient.
template <class S, class T>
struct BlendedTori {
  T phi = S(0), rho = S(0);  // the blend, not yet kept near the distance to the points; spacing
  S nearest = 0;             // distance to the nearest point
  S negative = 0;            // share of the weight that sees the place inside
};

/// Eq. 5.1 over the first n lanes; known: which side the place is on, 1 outside, -1 inside, 0 as
/// the tori see it.
template <class S>
using BlendKernel = void(const TorusLanes<S>&, int n, int known, BlendedTori<S, S>&);
/// The same with its gradient.
template <class S>
using SlopeKernel = void(const TorusLanes<S>&, const TorusAway<S>&, int n, int known,
                         BlendedTori<S, Slope<S>>&);

/// The fastest ones for the processor that runs the program.
template <class S>
BlendKernel<S>* blend_kernel();
template <class S>
SlopeKernel<S>* slope_kernel();

}  // namespace littoral

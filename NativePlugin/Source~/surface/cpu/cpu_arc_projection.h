// SPDX-License-Identifier: MIT
// A pack of vertices projected from the arcs nearest to them, one arc to each lane: project_on_arc() and the plain case
// of reproject() (stages/projection.h), with the same operations in the same order, so that a vertex comes out the same
// to the last bit whichever way it goes. Only for the CPU kernels.
#pragma once

#include "parallel/wide_pack.h"
#include "surface/stages/projection.h"

namespace quickses {
namespace QSES_CPU_ISA {

// dot() with the roundings that it has for single floats: compilers fuse the products of a sum in the order in which
// they meet them, which for packs, whose operators are functions, is another one.
QSES_FN WidePack dot_as_of_floats(const Vec3<WidePack> &a, const Vec3<WidePack> &b) {
  return multiply_add(a.z, b.z, multiply_add(a.x, b.x, a.y * b.y));
}
QSES_FN WidePack squared_as_of_floats(const Vec3<WidePack> &a) { return dot_as_of_floats(a, a); }

// One arc for each lane.
struct PackedArc {
  Vec3<WidePack> center;
  WidePack radius;
  Vec3<WidePack> middle;
  WidePack cos_half;
  Vec3<WidePack> side;
  WidePack sin_half;
};

// arc(l): that of a lane.
template <class ArcOf>
QSES_FN PackedArc load_arcs(const ArcOf &arc) {
  PackedArc a;
  load_rows([&](int l) { return &arc(l)->center.x; }, &a.center.x, &a.center.y, &a.center.z, &a.radius);
  load_rows([&](int l) { return &arc(l)->middle.x; }, &a.middle.x, &a.middle.y, &a.middle.z, &a.cos_half);
  load_rows([&](int l) { return &arc(l)->side.x; }, &a.side.x, &a.side.y, &a.side.z, &a.sin_half);
  return a;
}

struct PackedBoundary {
  Vec3<WidePack> position;
  WidePack distance;
  uint32_t at_end;  // lanes at an exposed vertex
};

// As boundary_on_arc() has it.
QSES_FN PackedBoundary boundary_on_arcs(const PackedArc &arc, const Vec3<WidePack> &x) {
  const Vec3<WidePack> t = x - arc.center;
  const WidePack along_middle = dot_as_of_floats(t, arc.middle), along_side = dot_as_of_floats(t, arc.side);
  const WidePack in_plane = square_root(multiply_add(along_middle, along_middle, along_side * along_side));
  const WideMask on_arc = along_middle >= arc.cos_half * in_plane, off_axis = in_plane > WidePack(1e-6f) * arc.radius;
  const WidePack past = arc.cos_half * absolute(along_side) - arc.sin_half * along_middle;
  const WidePack near = arc.cos_half * along_middle + arc.sin_half * absolute(along_side);
  const WideMask joint = (past <= WidePack(1e-3f) * in_plane + WidePack(1e-6f) * arc.radius) & (near >= WidePack(0.f));
  const WidePack end_sine = select(along_side < WidePack(0.f), -arc.sin_half, arc.sin_half);
  const WidePack cosine = select(on_arc, select(off_axis, along_middle / in_plane, WidePack(1.f)), arc.cos_half);
  const WidePack sine = select(on_arc, select(off_axis, along_side / in_plane, WidePack(0.f)), end_sine);
  PackedBoundary y;
  y.position = arc.center + arc.middle * (arc.radius * cosine) + arc.side * (arc.radius * sine);
  y.distance = square_root(squared_as_of_floats(y.position - x));
  y.at_end = ~lane_bits(on_arc) & ~lane_bits(joint) & kAllWideLanes;
  return y;
}

struct PackedSurfacePoint {
  Vec3<WidePack> position, normal;
  uint32_t near;  // lanes in which it can be trusted
};

// As place_on_surface() has it.
QSES_FN PackedSurfacePoint place_on_surface(const SurfaceParameters &p, const Vec3<WidePack> &x,
                                            const PackedBoundary &y) {
  const WidePack least(1e-9f);
  Vec3<WidePack> outward = (y.position - x) * (WidePack(1.f) / select(absolute(y.distance) > least, y.distance, least));
  const WidePack length2 = squared_as_of_floats(outward), inverse = reciprocal_root(length2);
  const WideMask has_length = length2 > WidePack(0.25f);
  outward = {select(has_length, outward.x * inverse, WidePack(0.f)),
             select(has_length, outward.y * inverse, WidePack(0.f)),
             select(has_length, outward.z * inverse, WidePack(1.f))};
  // In z the other one is the same for all starts without a direction, so there compilers round the product.
  const WidePack depth(p.depth);
  const Vec3<WidePack> position{y.position.x - outward.x * depth, y.position.y - outward.y * depth,
                                y.position.z - rounded_product(outward.z, depth)};
  return {position, outward,
          lane_bits(is_short_move(p, WidePack(p.depth) - y.distance, squared_as_of_floats(position - x)))};
}

struct PackedProjection {
  PackedSurfacePoint point;
  uint32_t at_end;
  uint32_t placed;       // lanes that are where they belong
  uint32_t reprojected;  // lanes that go on, of these
  uint32_t from_afar;    // those that count as two rounds
  uint32_t lost;         // lanes for whose distance rounding decides: as if they had no arc
};

// As project_on_arc() has it; every lane has an arc. second2: squared, of the second nearest.
QSES_FN PackedProjection project_on_arcs(const SurfaceParameters &p, const PackedArc &arc, WidePack second2,
                                         const Vec3<WidePack> &x) {
  const PackedBoundary y = boundary_on_arcs(arc, x);
  PackedProjection out;
  out.at_end = y.at_end;
  out.lost = p.depth > 0.f ? lane_bits(y.distance < WidePack(kProjectionTolerance)) : 0;
  out.point = place_on_surface(p, x, y);
  const WideMask beyond_axis =
      dot_as_of_floats(out.point.position - arc.center, y.position - arc.center) < WidePack(0.f);
  const uint32_t may_be_covered =
      lane_bits((y.distance < WidePack(p.depth - kProjectionTolerance)) &
                ((square_root(second2) < WidePack(2.f * p.depth) - y.distance) | beyond_axis));
  const uint32_t on = out.point.near & ~out.lost;
  out.from_afar = on & lane_bits(WidePack(p.depth) - y.distance > WidePack(kLongestWayIn * p.spacing));
  out.reprojected = out.from_afar | (on & may_be_covered);
  out.placed = on & ~out.reprojected;
  return out;
}

// As reproject() has it for vertices on the sphere of one probe, after one round: those of `lanes` that no other probe
// covers are placed. Of the others nothing is said.
QSES_FN PackedProjection keep_on_arcs(const SurfaceParameters &p, const PackedArc &arc, const Vec3<WidePack> &x,
                                      uint32_t lanes) {
  const PackedBoundary y = boundary_on_arcs(arc, x);
  PackedProjection out{};
  out.at_end = y.at_end;
  out.point = place_on_surface(p, x, y);
  out.placed = lanes & out.point.near & ~lane_bits(y.distance < WidePack(p.depth - kProjectionTolerance));
  return out;
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses

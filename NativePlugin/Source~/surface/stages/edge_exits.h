// SPDX-License-Identifier: MIT
// Vertices of the surfaces of balls held to their lattice edges. Marching cubes with each vertex where its edge leaves
// the balls hardly ever intersects itself; projected and relaxed, vertices get better triangles, but in grooves and
// channels narrower than the spacing they may come to lie on the wrong wall, and triangles fold. There each takes the
// place where its edge leaves the balls.
#pragma once

#include "surface/stages/creases.h"
#include "surface/stages/projection.h"
#include "surface/stages/side_normals.h"
#include "surface/stages/thin_channels.h"

namespace quickses {

// A triangle that relaxation turned further than to this cosine goes back to where its edges leave the balls.
constexpr float kLeastHeldTurn = 0.5f;

struct EdgeExit {
  Vec3<float> position, normal;  // centred frame
  uint32_t owner;                // caller's number
  uint32_t found;                // 1 or 0: nothing is known of the edge
};

// What is known of vertices: which come into question, as they are near several balls or in a channel; where their
// edges leave the balls; and which take that place.
struct HeldVertices {
  uint8_t *near, *held;  // [vertex]: 1 or 0
  EdgeExit *exits;       // [vertex] that is near
};

// Vertices of triangles between balls.
struct MarkMixedVertices {
  MeshView mesh;
  uint8_t *mixed;  // [vertex]
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t *const t = mesh.triangle(i);
    const uint32_t owner = mesh.owner(t[0]);
    if (owner == mesh.owner(t[1]) && owner == mesh.owner(t[2])) return;
    for (int k = 0; k < 3; ++k) atomic_set(mixed + t[k]);
  }
};

// Vertices of edges that end in a thin channel.
struct MarkChannelVertices {
  BrickSet bricks;
  MeshLayout layout;
  const uint64_t *channels;  // the marked points, numbered like signs
  uint8_t *marked;           // [vertex]
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t brick = brick_of_vertex(layout, {0, bricks.count}, static_cast<uint32_t>(i));
    const LatticeEdge edge = edge_of_vertex(layout, brick, static_cast<uint32_t>(i));
    const uint64_t word = layout.signs[size_t(brick) * kLeavesPerBrick + size_t(edge.leaf)];
    glm::ivec3 p = brick_point(edge.leaf, edge.bit);
    if (word >> edge.bit & 1) p += glm::ivec3(edge.axis == 0, edge.axis == 1, edge.axis == 2);  // the end outside
    marked[i] = sign_at(bricks, brick, p, channels, false) ? 1 : 0;
  }
};

// Those and the ones next to them, whose triangles change as they do.
struct MarkNearVertices {
  MeshView mesh;
  const uint8_t *mixed, *in_channel;
  uint8_t *near;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t *const t = mesh.triangle(i);
    bool any = false;
    for (int k = 0; k < 3; ++k) any |= mixed[t[k]] || in_channel[t[k]];
    for (int k = 0; k < 3 && any; ++k) atomic_set(near + t[k]);
  }
};

// At a glance, where the vertex's own ball is left; else of all that are near.
struct FindEdgeExits {
  FeatureView features;
  BrickSet bricks;
  MeshLayout layout;
  const uint32_t *places;     // caller's number of an atom -> its place in the grid
  const uint8_t *in_channel;  // [vertex]
  MeshView mesh;
  HeldVertices vertices;
  QSES_FN bool is_done_at_a_glance(size_t i) const {
    if (!vertices.near[i]) return true;
    if (in_channel[i]) return false;
    const EdgeExit exit = exit_of(i, edge_of(i));
    if (exit.found) vertices.exits[i] = exit;
    return exit.found;
  }
  QSES_FN void finish(size_t i) const {
    CutEdge edge = edge_of(i);
    EdgeExit exit{};
    if (in_channel[i]) {
      edge.outside = find_gap(features, edge.outside, bricks.lattice.spacing);
      exit = exit_of(i, edge);
    }
    if (!exit.found) exit = find_exit(edge);
    if (exit.found && (in_channel[i] || exit.owner != mesh.owner(static_cast<uint32_t>(i)))) vertices.held[i] = 1;
    vertices.exits[i] = exit;
  }

 private:
  QSES_FN CutEdge edge_of(size_t i) const {
    const uint32_t vertex = static_cast<uint32_t>(i), brick = brick_of_vertex(layout, {0, bricks.count}, vertex);
    return ends_of_edge(bricks, layout, brick, edge_of_vertex(layout, brick, vertex));
  }

  // Where the edge leaves the last ball on its way out. Unknown if the outside end is in one, as in a channel that was
  // not found again; but one on a sphere is outside.
  QSES_FN EdgeExit find_exit(const CutEdge &edge) const {
    constexpr float kOnSphere = 1e-4f;  // Å
    const Vec3<float> way = edge.outside - edge.inside;
    const float end = 1.f + kOnSphere * reciprocal_root(length_squared(way));
    float last = -1.f;
    uint32_t place = 0;
    const bool is_clear = for_balls_near(features, edge.inside, edge.outside, 0.f, NearBalls::kMostMet,
                                         [&](uint32_t at, const Sphere &ball) {
                                           float entry, exit;
                                           if (!meet_ball(ball, edge.inside, way, &entry, &exit) || entry >= 1.f)
                                             return true;
                                           if (exit > last) last = exit, place = at;
                                           return exit <= end;
                                         });
    if (!is_clear || last < 0.f) return {};
    return describe(place, load(features.atoms.items + place), edge.inside + way * last);
  }

  // Where it leaves the ball that the vertex is on, if it is there on the surface, as it is as a rule.
  QSES_FN EdgeExit exit_of(size_t i, const CutEdge &edge) const {
    const uint32_t place = places[mesh.owner(static_cast<uint32_t>(i))];
    const Sphere ball = load(features.atoms.items + place);
    const Vec3<float> way = edge.outside - edge.inside;
    float entry, exit;
    if (!meet_ball(ball, edge.inside, way, &entry, &exit) || !(entry <= 0.f && exit >= 0.f && exit <= 1.f)) return {};
    const Vec3<float> x = edge.inside + way * exit;
    if (!is_exposed(features, place, x - Vec3<float>(ball.center), ball.radius)) return {};
    return describe(place, ball, x);
  }

  QSES_FN EdgeExit describe(uint32_t place, const Sphere &ball, const Vec3<float> &x) const {
    const Vec3<float> normal = sphere_normal(ball, x);
    return {Vec3<float>(ball.center) + normal * ball.radius, normal, features.atoms.order[place], 1};
  }
};

// Triangles that are turned, compared with where their edges leave the balls.
struct MarkTurnedVertices {
  Lattice lattice;
  MeshView mesh;
  HeldVertices vertices;
  uint8_t *turned;  // [vertex]
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t *const t = mesh.triangle(i);
    Vec3<float> now[3], exit[3];
    bool any = false;
    for (int k = 0; k < 3; ++k) {
      now[k] = exit[k] = lattice.from_caller(mesh.position(t[k]));
      if (!vertices.near[t[k]] || !vertices.exits[t[k]].found) continue;
      exit[k] = vertices.exits[t[k]].position;
      any |= !vertices.held[t[k]];
    }
    if (!any) return;
    const Vec3<float> a = cross(now[1] - now[0], now[2] - now[0]), b = cross(exit[1] - exit[0], exit[2] - exit[0]);
    if (dot(a, b) > kLeastHeldTurn * square_root(length_squared(a) * length_squared(b))) return;
    for (int k = 0; k < 3; ++k) atomic_set(turned + t[k]);
  }
};

// Puts the vertices that are marked where their edges leave the balls.
struct HoldVertices {
  Lattice lattice;
  MeshView mesh;
  HeldVertices vertices;
  const uint8_t *marked;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    if (!marked[i] || !vertices.near[i] || !vertices.exits[i].found) return;
    const uint32_t vertex = static_cast<uint32_t>(i);
    const EdgeExit &exit = vertices.exits[i];
    store_vec3(mesh.position(vertex), Vec3<float>(lattice.to_caller(exit.position)));
    store_normals(mesh, vertex, exit.normal, exit.normal);
    mesh.owner(vertex) = exit.owner;
    if (mesh.patches) mesh.patch(vertex) = QSES_PATCH_CONTACT;  // of one ball's surface
  }
};

}  // namespace quickses

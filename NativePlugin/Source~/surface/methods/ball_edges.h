// SPDX-License-Identifier: MIT
// What a mesh of the surface of balls gets before its creases are split: channels thinner than the spacing, and
// vertices that are on the right wall of narrow grooves.
#pragma once

#include "parallel/two_step_pass.h"
#include "surface/methods/level_work.h"
#include "surface/stages/edge_exits.h"

namespace quickses {

// Opens thin channels in the signs of all bricks. opened: the points that were, numbered like signs.
template <class Work>
void open_thin_channels(Work &work, const BrickSet &bricks, uint64_t *signs, Span<uint64_t> opened) {
  auto &executor = work.executor;
  work.timer.begin("thin_walls");
  executor.fill(opened, 0);
  executor.template for_each_brick<ChannelScratch>(
      bricks.count, MarkThinChannels{work.features, bricks, signs, opened.data}, 8, 8 * BrickBalls::kMostMet);
  executor.for_each(opened.size, RemoveMarks{opened.data, signs});
}

// Holds vertices of grooves and channels to their lattice edges.
template <class Work>
void hold_to_edges(Work &work, const BrickSet &bricks, const MeshLayout &layout, const uint64_t *channels,
                   const MeshMemoryView &mesh) {
  auto &executor = work.executor;
  work.timer.begin("creases");
  const size_t n = mesh.vertices;
  const auto room = [&](size_t size) {
    return work.memory.template allocate_where_mesh_is<uint8_t>(executor, mesh, size);
  };
  Span<uint8_t> flags[5];
  for (Span<uint8_t> &f : flags) executor.fill(f = room(n), 0);
  uint8_t *const mixed = flags[0].data, *const in_channel = flags[1].data, *const turned = flags[2].data;
  const HeldVertices vertices{flags[3].data, flags[4].data,
                              work.memory.template allocate_where_mesh_is<EdgeExit>(executor, mesh, n).data};
  const Lattice &lattice = bricks.lattice;
  executor.for_each(mesh.triangles, MarkMixedVertices{mesh.view, mixed});
  executor.for_each(n, MarkChannelVertices{bricks, layout, channels, in_channel});
  executor.for_each(mesh.triangles, MarkNearVertices{mesh.view, mixed, in_channel, vertices.near});
  for_each_in_two_steps(executor, n,
                        FindEdgeExits{work.features, bricks, layout, work.atom_places, in_channel, mesh.view, vertices},
                        NearBalls::kMostMet);
  executor.for_each(n, HoldVertices{lattice, mesh.view, vertices, vertices.held});
  executor.for_each(mesh.triangles, MarkTurnedVertices{lattice, mesh.view, vertices, turned});
  executor.for_each(n, HoldVertices{lattice, mesh.view, vertices, turned});
}

}  // namespace quickses

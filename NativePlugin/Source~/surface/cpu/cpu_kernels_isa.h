// SPDX-License-Identifier: MIT
// Declares the kernels of one instruction set. Included by the files that are compiled once per instruction set, and
// once per set (hence no include guard around the declarations) by cpu_dispatch.cpp.
#include "surface/cpu/cpu_kernels.h"

#ifndef QSES_CPU_ISA
#define QSES_CPU_ISA base
#endif

namespace quickses {
namespace QSES_CPU_ISA {

AtomFeatures find_atom_features(const NeighborGridView &atoms, const SurfaceParameters &parameters, uint32_t i,
                                const AtomScratch &scratch, Cap *caps, int cap_room, Arc *arcs, int64_t arc_room,
                                uint8_t *exposed);

BrickNeeds evaluate_brick_signs(const FeatureView &features, const BrickSet &bricks, uint32_t brick,
                                const BrickScratch &scratch, uint64_t *words);

BrickNeeds emit_brick_vertices(const FeatureView &features, const BrickSet &bricks, const MeshLayout &layout,
                               uint32_t brick, const VertexStarts &starts, const BrickScratch &scratch,
                               const MeshView &mesh);

void emit_brick_triangles(const BrickSet &bricks, const MeshLayout &layout, uint32_t brick, const TableView &table,
                          const MeshView &mesh);

}  // namespace QSES_CPU_ISA
}  // namespace quickses

// SPDX-License-Identifier: MIT
// The density of Gaussians about the atoms, as QuickSurf of VMD defines it (Krone, Stone, Ertl and Schulten 2012): the
// sum of exp(-d² / 2s²), where s is the atom's radius times a scale, and atoms farther than 4 s (VMD's best quality)
// add nothing. The surface is where it has the isovalue.
#pragma once

#include "surface/stages/marching_cubes.h"

namespace quickses {

// Standard deviations after which an atom's density ends.
constexpr float kGaussianReach = 4.f;
constexpr float kHalfReach2 = 0.5f * kGaussianReach * kGaussianReach;

// exp(x) for x from -kHalfReach2 to 0, within 1e-6 of itself: the eighth power of a Taylor series about -1/2.
template <class F>
QSES_FN F gaussian_series(F x) {
  const F u = x * F(0.125f) + F(0.5f);  // from -1/2 to 1/2
  F e = u * F(1.f / 5040) + F(1.f / 720);
  e = e * u + F(1.f / 120);
  e = e * u + F(1.f / 24);
  e = e * u + F(1.f / 6);
  e = e * u + F(0.5f);
  e = e * u + F(1.f);
  e = (e * u + F(1.f)) * F(0.60653066f);
  e = e * e;
  e = e * e;
  return e * e;
}
QSES_FN float gaussian(float x) {
#if defined(__CUDA_ARCH__)
  return __expf(x);
#else
  return gaussian_series(x);
#endif
}

struct GaussianDensity {
  NeighborGridView atoms;  // with the radii where their densities end
  float max_radius;        // of those
  float isovalue;
  float atom_part;  // an atom's radius over that where its density ends

  template <class F>
  struct Sum {
    F density;
    Vec3<F> gradient;
  };
  using Value = Sum<float>;

  static constexpr int kMostLooks = 12;  // for a vertex

  // Where atoms can be that add to the density in a box.
  QSES_FN CellBox cells_near(const Vec3<float> &low, const Vec3<float> &high) const {
    return cells_within(atoms.cells, low, high, max_radius);
  }
  // Calls visit(atom, number) for them, always in the same order.
  template <class Visit>
  QSES_FN void visit_atoms(const CellBox &box, const Visit &visit) const {
    atoms.for_each_run(box, [&](const ItemRun &run) {
      for (uint32_t k = run.begin; k < run.end; ++k) visit(load(&atoms.items[k]), k);
      return true;
    });
  }

  // Adds what an atom adds at a place, where it reaches that: d from its centre, of which d2 is the square, at most
  // end2.
  template <class F, class Mask>
  QSES_FN static void add(const Vec3<F> &d, F d2, F end2, Mask reaches, Sum<F> *sum) {
    const F slope = F(-kHalfReach2) / end2, e = select(reaches, gaussian(slope * d2), F(0.f));
    sum->density = sum->density + e;
    sum->gradient = sum->gradient + d * (F(2.f) * slope * e);
  }

  QSES_FN Value at(const Vec3<float> &x) const {
    Value sum{0.f, Vec3<float>(0.f, 0.f, 0.f)};
    visit_atoms(cells_near(x, x), [&](const Sphere &atom, uint32_t) {
      const Vec3<float> d = x - Vec3<float>(atom.center);
      const float d2 = dot(d, d), end2 = atom.radius * atom.radius;
      if (d2 < end2) add(d, d2, end2, true, &sum);
    });
    return sum;
  }

  // What an atom adds at least and at most to the points of a box, of which middle and half the edges are given. That
  // is rounded: sums are to be multiplied with these before they decide.
  static constexpr float kSurelyLess = 0.999f, kSurelyMore = 1.001f;
  template <class F>
  QSES_FN static void add_bounds(const Vec3<F> &center, F end2, const Vec3<F> &middle, const Vec3<F> &half, F *least,
                                 F *most) {
    const F slope = F(-kHalfReach2) / maximum(end2, F(1e-20f)), zero(0.f);
    const Vec3<F> d(absolute(center.x - middle.x), absolute(center.y - middle.y), absolute(center.z - middle.z));
    const Vec3<F> farthest = d + half;
    const Vec3<F> nearest(maximum(zero, d.x - half.x), maximum(zero, d.y - half.y), maximum(zero, d.z - half.z));
    const F most2 = dot(farthest, farthest), least2 = dot(nearest, nearest);
    *least = *least + select(most2 < end2, gaussian(slope * minimum(most2, end2)), zero);
    *most = *most + select(least2 < end2, gaussian(slope * minimum(least2, end2)), zero);
  }

  // Place in the grid of the atom whose van der Waals surface is nearest; of several, of the smallest number.
  QSES_FN uint32_t owner_at(const Vec3<float> &x) const {
    uint32_t best = 0;
    float nearest = kFarAway;
    visit_atoms(cells_near(x, x), [&](const Sphere &atom, uint32_t k) {
      const Vec3<float> d = x - Vec3<float>(atom.center);
      const float distance = square_root(dot(d, d)) - atom_part * atom.radius;
      if (distance < nearest || (distance == nearest && atoms.order[k] < atoms.order[best])) {
        nearest = distance;
        best = k;
      }
    });
    return best;
  }
};

// Where an edge has the isovalue, in parts of it from its end inside.
struct IsovaluePlace {
  float part;
  GaussianDensity::Value found;  // close to it
};
// at(x): the density at a place.
template <class At>
QSES_FN IsovaluePlace find_isovalue(const CutEdge &edge, float isovalue, const At &at) {
  const Vec3<float> along = edge.outside - edge.inside;
  float inner = 0.f, outer = 1.f, before = 0.f;
  bool halves = false;
  IsovaluePlace place{0.5f, {}};
  for (int step = 0; step < GaussianDensity::kMostLooks;
       ++step) {  // Newton's, between what is known to be inside and outside
    float &t = place.part;
    place.found = at(edge.inside + along * t);
    const float above = place.found.density - isovalue, slope = dot(place.found.gradient, along);
    // Where an atom's density ends, the sum falls at once: Newton's steps go to and fro across that.
    halves = halves || (above * before < 0.f && absolute(above) > 0.5f * absolute(before));
    before = above;
    (above > 0.f ? inner : outer) = t;
    const float next = halves ? 0.5f * (inner + outer) : t - above / slope;
    if (absolute(next - t) < 1e-3f) {  // the next step would be a thousandth of this one
      t = minimum(1.f, maximum(0.f, next));
      break;
    }
    t = next > inner && next < outer ? next : 0.5f * (inner + outer);
  }
  return place;
}

// Writes a vertex. owner(x): the place of the owner in the grid.
template <class At, class Owner>
QSES_FN void place_density_vertex(const GaussianDensity &density, const BrickSet &bricks, const MeshLayout &layout,
                                  uint32_t brick, uint32_t vertex, const MeshView &mesh, const At &at,
                                  const Owner &owner) {
  const CutEdge edge = ends_of_edge(bricks, layout, brick, edge_of_vertex(layout, brick, vertex));
  const IsovaluePlace place = find_isovalue(edge, density.isovalue, at);
  const Vec3<float> along = edge.outside - edge.inside, x = edge.inside + along * place.part;
  const Vec3<float> &gradient = place.found.gradient;
  const float steepness2 = dot(gradient, gradient);
  mesh.owner(vertex) = density.atoms.order[owner(x)];
  store_vec3(mesh.position(vertex), Vec3<float>(bricks.lattice.to_caller(x)));
  store_vec3(mesh.normal(vertex), steepness2 > 1e-20f ? gradient * (-1.f / square_root(steepness2))
                                                      : along * (1.f / square_root(dot(along, along))));
}

}  // namespace quickses

// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using UMol;
using UnityEngine;

/// <summary>Selections of atoms, made of numbers that are the same in every run.</summary>
internal static class Selections
{
    /// <summary>Atoms at random in a cube of such an edge that they overlap as those of a protein do.</summary>
    public static UnityMolSelection Blob(int count, int seed)
    {
        var random = new System.Random(seed);
        double edge = 2.2 * Math.Pow(count, 1.0 / 3);
        var atoms = new List<UnityMolAtom>();
        for (int i = 0; i < count; ++i)
            atoms.Add(new UnityMolAtom
            {
                position = new Vector3(
                    (float)(edge * random.NextDouble()), (float)(edge * random.NextDouble()),
                    (float)(edge * random.NextDouble())),
                radius = 1.2f + 0.6f * (float)random.NextDouble(),
                idInAllAtoms = i
            });
        return new UnityMolSelection { atoms = atoms };
    }

    public static UnityMolSelection Of(params UnityMolAtom[] atoms) =>
        new UnityMolSelection { atoms = new List<UnityMolAtom>(atoms) };

    public static UnityMolAtom Atom(float x, float y, float z, float radius) =>
        new UnityMolAtom { position = new Vector3(x, y, z), radius = radius };

    public static Vector3[] Positions(UnityMolSelection selection) =>
        selection.atoms.ConvertAll(atom => atom.position).ToArray();

    public static float[] Radii(UnityMolSelection selection) =>
        selection.atoms.ConvertAll(atom => atom.radius).ToArray();
}

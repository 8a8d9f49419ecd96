// SPDX-License-Identifier: MIT
// UnityMol 1.2.0 as the replacement of its wrapper sees it: the names and types of what is used, and nothing else.
using System.Collections.Generic;
using UnityEngine;

/// <summary>Arrays are capacities, counts are separate.</summary>
public class MeshData
{
    public int[] triangles;
    public Vector3[] normals;
    public Vector3[] vertices;
    public Color32[] colors;
    public int[] atomByVert;
    public int nVert;
    public int nTri;
}

namespace UMol
{
    public class UnityMolAtom
    {
        public Vector3 position;
        public float radius;
        public int idInAllAtoms = -1;
    }

    public class UnityMolSelection
    {
        public List<UnityMolAtom> atoms { get; set; }
        public List<Vector3[]> extractTrajFramePositions;
    }
}

// SPDX-License-Identifier: MIT
namespace QuickSes
{
    /// <summary>Where a surface has the colours of its atoms.</summary>
    public enum AtomColoring
    {
        /// <summary>In a texture if the shader of the renderer's first material takes them from there, else in vertices.</summary>
        Auto = 0,
        /// <summary>
        /// In the vertices (attribute Color), for any shader that reads vertex colours, and for scripts that read the mesh.
        /// New colours are 4 bytes per vertex, over several frames for large surfaces; hidden atoms another copy.
        /// </summary>
        Vertices = 1,
        /// <summary>
        /// In a texture of one texel per atom; vertices have the number of their atom (attribute TexCoord7). New colours and
        /// hidden atoms are 4 bytes per atom, at once. For the package's shader and others that have its property
        /// _QuickSesAtomColors.
        /// </summary>
        Texture = 2
    }
}

// SPDX-License-Identifier: MIT
namespace QuickSes
{
    /// <summary>Where a file of atoms or frames is.</summary>
    public enum MoleculeSourceKind
    {
        /// <summary>Nowhere: nothing is chosen.</summary>
        None = 0,
        /// <summary>
        /// An asset, which travels with scenes and builds. Unity imports files with names such as "1crn.pdb.txt",
        /// "md.xtc.bytes" and "2k39.pdb.gz.bytes" as text assets.
        /// </summary>
        TextAsset = 1,
        /// <summary>A path below the folder Assets/StreamingAssets, which desktop players copy.</summary>
        StreamingAssets = 2,
        /// <summary>An absolute path on this machine.</summary>
        File = 3
    }
}

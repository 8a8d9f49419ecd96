// SPDX-License-Identifier: MIT
namespace QuickSes
{
    /// <summary>Where a file of atoms or frames is.</summary>
    public enum MoleculeSourceKind
    {
        /// <summary>Nowhere: nothing is chosen.</summary>
        None = 0,
        /// <summary>
        /// A text asset, which travels with scenes and builds: what Unity makes of files with names such as
        /// "1crn.pdb.txt", "md.xtc.bytes" and "2k39.pdb.gz.bytes".
        /// </summary>
        TextAsset = 1,
        /// <summary>A path below the folder Assets/StreamingAssets, which desktop players copy.</summary>
        StreamingAssets = 2,
        /// <summary>An absolute path on this machine.</summary>
        File = 3,
        /// <summary>
        /// A <see cref="QuickSes.MoleculeAsset"/>, which travels with scenes and builds: what the package makes of files
        /// with names such as "1crn.pdb", "1aon.cif.gz" and "md.xtc" in Assets.
        /// </summary>
        MoleculeAsset = 4
    }
}

// SPDX-License-Identifier: MIT
namespace QuickSes
{
    /// <summary>
    /// What is read of a file of atoms. <c>default</c> is the defaults: everything of the first model.
    /// </summary>
    public struct StructureOptions
    {
        /// <summary>The format; default: found out.</summary>
        public StructureFormat Format { get; set; }

        /// <summary>Place of the model in the file, from 1; 0 (default) is the first one too.</summary>
        public int Model { get; set; }

        /// <summary>Whether waters are left out.</summary>
        public bool SkipWater { get; set; }

        /// <summary>Whether HETATM records are left out; waters are mostly among them.</summary>
        public bool SkipHetero { get; set; }

        /// <summary>Whether hydrogen and deuterium are left out.</summary>
        public bool SkipHydrogen { get; set; }

        /// <summary>
        /// Words such as "protein and not chain B", or CID such as "//A/10-40"; null (default): everything. Of all
        /// atoms of the model, those that are left out by the other options too.
        /// </summary>
        public string Selection { get; set; }

        /// <summary>
        /// "quickses", "bondi", or the path of a text file with lines `ELEMENT radius` (Å; `*` for all others) and
        /// `RESIDUE ATOM radius` (either may be `*`), of which the most specific holds. null (default): those of the file
        /// (PQR, XYZR), else "quickses". Must be null for PQR and XYZR.
        /// </summary>
        public string Radii { get; set; }

        /// <summary>
        /// The name of a biological assembly of a PDB or mmCIF file, mostly "1"; null (default): the atoms of the file.
        /// Further copies of a chain have 2, 3 and so on behind its name. An assembly fits no trajectory of the file.
        /// </summary>
        public string Assembly { get; set; }

        /// <summary>
        /// Which alternate locations are taken: "first" of each residue; "highest", of the greatest mean occupancy; or a
        /// label such as "B" where a residue has it, else the first. null (default): "first".
        /// </summary>
        public string AlternateLocation { get; set; }
    }
}

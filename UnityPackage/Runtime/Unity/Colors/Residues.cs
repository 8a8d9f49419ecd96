// SPDX-License-Identifier: MIT
using System.Collections.Generic;

namespace QuickSes
{
    internal enum ResidueClass
    {
        Other,
        Nonpolar,
        Polar,
        Acidic,
        Basic,
        Purine,
        Pyrimidine
    }

    /// <summary>What is known about residues by their names in files of the PDB and of molecular dynamics.</summary>
    internal static class Residues
    {
        public static ResidueClass ClassOf(string name) =>
            s_table.TryGetValue(name, out Entry entry) ? entry.Class : ResidueClass.Other;

        /// <summary>
        /// From -4.5 (arginine) to 4.5 (isoleucine): Kyte and Doolittle, J. Mol. Biol. 157, 105-132 (1982).
        /// </summary>
        public static bool TryGetHydropathy(string name, out float hydropathy)
        {
            bool isAminoAcid = s_table.TryGetValue(name, out Entry entry) && entry.IsAminoAcid;
            hydropathy = entry.Hydropathy;
            return isAminoAcid;
        }

        public const float GreatestHydropathy = 4.5f;

        private readonly struct Entry
        {
            public Entry(ResidueClass residueClass, float hydropathy)
            {
                Class = residueClass;
                Hydropathy = hydropathy;
            }

            public readonly ResidueClass Class;
            public readonly float Hydropathy;

            public bool IsAminoAcid => Class >= ResidueClass.Nonpolar && Class <= ResidueClass.Basic;
        }

        private static readonly Dictionary<string, Entry> s_table = MakeTable();

        private static Dictionary<string, Entry> MakeTable()
        {
            var table = new Dictionary<string, Entry>();
            void Add(ResidueClass residueClass, float hydropathy, params string[] names)
            {
                foreach (string name in names)
                    table.Add(name, new Entry(residueClass, hydropathy));
            }
            // After the standard name those of modified residues, and of other protonation states and programs.
            Add(ResidueClass.Nonpolar, 1.8f, "ALA");
            Add(ResidueClass.Nonpolar, -0.4f, "GLY");
            Add(ResidueClass.Nonpolar, 4.5f, "ILE");
            Add(ResidueClass.Nonpolar, 3.8f, "LEU");
            Add(ResidueClass.Nonpolar, 1.9f, "MET", "MSE");
            Add(ResidueClass.Nonpolar, 2.8f, "PHE");
            Add(ResidueClass.Nonpolar, -1.6f, "PRO", "HYP");
            Add(ResidueClass.Nonpolar, -0.9f, "TRP");
            Add(ResidueClass.Nonpolar, 4.2f, "VAL");
            Add(ResidueClass.Polar, -3.5f, "ASN");
            Add(ResidueClass.Polar, 2.5f, "CYS", "CYX", "CYM", "CYS2", "SEC");
            Add(ResidueClass.Polar, -3.5f, "GLN");
            Add(ResidueClass.Polar, -0.8f, "SER", "SEP");
            Add(ResidueClass.Polar, -0.7f, "THR", "TPO");
            Add(ResidueClass.Polar, -1.3f, "TYR", "PTR");
            Add(ResidueClass.Acidic, -3.5f, "ASP", "ASH", "ASPH");
            Add(ResidueClass.Acidic, -3.5f, "GLU", "GLH", "GLUH");
            Add(ResidueClass.Basic, -4.5f, "ARG", "ARGN");
            Add(ResidueClass.Basic, -3.2f, "HIS", "HID", "HIE", "HIP", "HSD", "HSE", "HSP", "HISA", "HISB", "HISH",
                "HISD", "HISE");
            Add(ResidueClass.Basic, -3.9f, "LYS", "LYN", "LYSH", "PYL");
            foreach (string ending in new[] { "", "5", "3" }) // the ends of a strand have names of their own in Amber
            {
                foreach (string prefix in new[] { "", "D", "R" })
                {
                    foreach (string purine in new[] { "A", "G", "I" })
                        Add(ResidueClass.Purine, 0, prefix + purine + ending);
                    foreach (string pyrimidine in new[] { "C", "T", "U" })
                        Add(ResidueClass.Pyrimidine, 0, prefix + pyrimidine + ending);
                }
            }
            Add(ResidueClass.Purine, 0, "ADE", "GUA");
            Add(ResidueClass.Pyrimidine, 0, "CYT", "THY", "URA");
            return table;
        }
    }
}

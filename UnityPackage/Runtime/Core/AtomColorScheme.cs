// SPDX-License-Identifier: MIT
namespace QuickSes
{
    /// <summary>
    /// How the atoms of a structure are coloured. Chains and places in them are those of the file, whatever was left out
    /// when the structure was opened.
    /// </summary>
    public enum AtomColorScheme
    {
        /// <summary>One colour for all.</summary>
        Uniform = 0,
        /// <summary>By element, in the colours of Jmol: carbon grey, nitrogen blue, oxygen red, ...</summary>
        Element = 1,
        /// <summary>A colour per chain, in the order of the file.</summary>
        Chain = 2,
        /// <summary>
        /// Acidic residues red, basic blue, polar green, nonpolar white; purines orange, pyrimidines violet.
        /// </summary>
        Residue = 3,
        /// <summary>Kyte and Doolittle's scale: hydrophilic residues blue, hydrophobic ones orange-red.</summary>
        Hydrophobicity = 4,
        /// <summary>Along each chain from blue (N terminus, 5' end) to red (C terminus, 3' end).</summary>
        Sequence = 5
    }
}

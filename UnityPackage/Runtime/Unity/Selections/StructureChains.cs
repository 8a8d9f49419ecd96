// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;

namespace QuickSes
{
    internal static class StructureChains
    {
        /// <summary>The names of the chains of a structure's atoms, each once, in the order of the file.</summary>
        public static List<string> Of(Structure structure)
        {
            var chains = new List<string>();
            var known = new HashSet<string>();
            ReadOnlySpan<uint> residues = structure.Residues;
            for (int i = 0; i < residues.Length; ++i)
            {
                if (i > 0 && residues[i] == residues[i - 1])
                    continue;
                string chain = structure.GetAtom(i).Chain;
                if (chain.Length > 0 && known.Add(chain))
                    chains.Add(chain);
            }
            return chains;
        }
    }
}

// SPDX-License-Identifier: MIT
using System;
using System.Globalization;

namespace QuickSes.Editor
{
    /// <summary>What a <see cref="MoleculeSource"/> leads to, after its filters.</summary>
    internal sealed class StructurePreview
    {
        private StructurePreview()
        {
        }

        /// <summary>What is wrong with the file or the options; "": nothing, and the rest is filled in.</summary>
        public string Error { get; private set; } = "";

        /// <summary>Atoms after filters.</summary>
        public int AtomCount { get; private set; }

        /// <summary>Atoms of the model in the file.</summary>
        public int FileAtomCount { get; private set; }

        public int Model { get; private set; }

        public int ModelCount { get; private set; }

        /// <summary>Chains of the atoms after filters; 0: the format has none.</summary>
        public int ChainCount { get; private set; }

        public StructureFormat Format { get; private set; }

        /// <summary>Whether a <see cref="TrajectoryPlayer"/> can show one model after the other.</summary>
        public bool HasPlayableModels => Format == StructureFormat.Pdb && ModelCount > 1;

        /// <summary>The reader's sentences for the user.</summary>
        public string[] Warnings { get; private set; } = Array.Empty<string>();

        /// <summary>One line about the atoms; "" if there are none.</summary>
        public string Summary
        {
            get
            {
                if (Error.Length > 0)
                    return "";
                FormattableString text = AtomCount == FileAtomCount
                    ? AtomCount == 1 ? (FormattableString)$"1 atom" : $"{AtomCount:N0} atoms"
                    : (FormattableString)$"{AtomCount:N0} of {FileAtomCount:N0} atoms";
                string summary = text.ToString(CultureInfo.InvariantCulture);
                if (ChainCount > 0)
                    summary += ChainCount == 1 ? ", 1 chain" : $", {ChainCount} chains";
                if (ModelCount > 1)
                    summary += $", model {Model} of {ModelCount}";
                return $"{summary} ({Format.ToString().ToUpperInvariant()})";
            }
        }

        /// <summary>There is nothing to preview.</summary>
        public static StructurePreview OfError(in QuickSesError error) =>
            new StructurePreview { Error = error.Message };

        /// <summary>Of one that is open.</summary>
        public static StructurePreview Of(Structure structure)
        {
            var warnings = new string[structure.WarningCount];
            for (int k = 0; k < warnings.Length; ++k)
                warnings[k] = structure.GetWarning(k);
            return new StructurePreview
            {
                AtomCount = structure.AtomCount,
                FileAtomCount = structure.FileAtomCount,
                Model = structure.Model,
                ModelCount = structure.ModelCount,
                ChainCount = StructureChains.Of(structure).Count,
                Format = structure.Format,
                Warnings = warnings
            };
        }
    }
}

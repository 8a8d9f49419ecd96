// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>
    /// What the file says about one atom. Strings are never null; XYZR files have none, so they are "" there.
    /// </summary>
    public readonly struct StructureAtom
    {
        internal unsafe StructureAtom(in NativeAtom native)
        {
            Name = NativeText.Read(native.Name);
            ResidueName = NativeText.Read(native.ResidueName);
            Chain = NativeText.Read(native.Chain);
            ResidueNumber = native.ResidueNumber;
            InsertionCode = (char)native.InsertionCode;
            Element = native.Element;
            IsHetero = native.IsHetero != 0;
            IsWater = native.IsWater != 0;
            IsHydrogen = native.IsHydrogen != 0;
        }

        /// <summary>Such as "CA".</summary>
        public string Name { get; }

        /// <summary>Such as "ALA".</summary>
        public string ResidueName { get; }

        /// <summary>Name of the chain.</summary>
        public string Chain { get; }

        /// <summary>
        /// As in the file; 0 also where there is none (<see cref="Structure.Residues"/> tells such residues apart).
        /// </summary>
        public int ResidueNumber { get; }

        /// <summary>' ' if there is none.</summary>
        public char InsertionCode { get; }

        /// <summary>Atomic number; 0: unknown; deuterium is 1.</summary>
        public byte Element { get; }

        /// <summary>A HETATM record.</summary>
        public bool IsHetero { get; }

        /// <summary>Its residue is water.</summary>
        public bool IsWater { get; }

        /// <summary>Hydrogen or deuterium.</summary>
        public bool IsHydrogen { get; }

        /// <summary>Such as "CA of ALA 12, chain A"; of a file without names, "".</summary>
        public override string ToString()
        {
            if (Name.Length == 0 && ResidueName.Length == 0)
                return "";
            string place = FormattableString.Invariant($"{ResidueName} {ResidueNumber}").TrimStart();
            if (Name.Length > 0)
                place = $"{Name} of {place}";
            if (InsertionCode != ' ' && InsertionCode != '\0')
                place += InsertionCode;
            return Chain.Length == 0 ? place : $"{place}, chain {Chain}";
        }
    }
}

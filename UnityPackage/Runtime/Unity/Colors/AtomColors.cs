// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes
{
    /// <summary>Colours of atoms from what a file says about them. Any thread. For loading: makes garbage.</summary>
    public static class AtomColors
    {
        /// <summary>Fills in a colour per atom (sRGB, opaque).</summary>
        /// <param name="structure">N atoms.</param>
        /// <param name="scheme">What the colours tell.</param>
        /// <param name="uniform">
        /// For <see cref="AtomColorScheme.Uniform"/>, and for atoms of which the scheme tells nothing, such as those of
        /// ligands in the schemes of residues.
        /// </param>
        /// <param name="colors">Room for N or more.</param>
        public static void Fill(Structure structure, AtomColorScheme scheme, Color32 uniform, Span<Color32> colors)
        {
            if (structure == null)
                throw new ArgumentNullException(nameof(structure));
            int count = structure.AtomCount;
            if (colors.Length < count)
                throw new ArgumentException($"has room for {colors.Length} of {count} colors", nameof(colors));
            colors = colors.Slice(0, count);
            colors.Fill(uniform);
            switch (scheme)
            {
                case AtomColorScheme.Uniform:
                    break;
                case AtomColorScheme.Element:
                    FillByElement(structure, colors);
                    break;
                case AtomColorScheme.Chain:
                    FillByChain(structure, colors);
                    break;
                case AtomColorScheme.Residue:
                    FillByResidue(structure, colors);
                    break;
                case AtomColorScheme.Hydrophobicity:
                    FillByHydrophobicity(structure, colors);
                    break;
                case AtomColorScheme.Sequence:
                    FillBySequence(structure, colors);
                    break;
                default:
                    throw new ArgumentOutOfRangeException(nameof(scheme), scheme, "there is no such scheme");
            }
            GC.KeepAlive(structure);
        }

        private static void FillByElement(Structure structure, Span<Color32> colors)
        {
            ReadOnlySpan<byte> elements = structure.FileElements;
            ReadOnlySpan<uint> indices = structure.FileIndices;
            for (int i = 0; i < colors.Length; ++i)
                if (ElementColors.TryGet(elements[(int)indices[i]], out Color32 color))
                    colors[i] = color;
        }

        private static void FillByChain(Structure structure, Span<Color32> colors)
        {
            var chains = new Dictionary<string, int>();
            for (int i = 0; i < colors.Length; ++i)
            {
                string chain = structure.GetAtom(i).Chain;
                if (chain.Length == 0)
                    continue;
                if (!chains.TryGetValue(chain, out int k))
                    chains.Add(chain, k = chains.Count);
                colors[i] = OfChain(k);
            }
        }

        // Hues a golden section of the circle apart: any number of chains differ, and neighbours most.
        private static Color32 OfChain(int k)
        {
            const double goldenSection = 0.6180339887498949;
            return FromHue((float)((0.58 + k * goldenSection) % 1), 0.6f);
        }

        private static void FillByResidue(Structure structure, Span<Color32> colors)
        {
            for (int i = 0; i < colors.Length; ++i)
            {
                ResidueClass residueClass = Residues.ClassOf(structure.GetAtom(i).ResidueName);
                if (residueClass != ResidueClass.Other)
                    colors[i] = OfClass(residueClass);
            }
        }

        private static Color32 OfClass(ResidueClass residueClass)
        {
            switch (residueClass)
            {
                case ResidueClass.Nonpolar:
                    return ElementColors.FromRgb(0xF2F2F2);
                case ResidueClass.Polar:
                    return ElementColors.FromRgb(0x4DBD5F);
                case ResidueClass.Acidic:
                    return ElementColors.FromRgb(0xE5383B);
                case ResidueClass.Basic:
                    return ElementColors.FromRgb(0x3A6FE0);
                case ResidueClass.Purine:
                    return ElementColors.FromRgb(0xF0A030);
                default:
                    return ElementColors.FromRgb(0x9B5DE5);
            }
        }

        private static void FillByHydrophobicity(Structure structure, Span<Color32> colors)
        {
            Color32 hydrophilic = ElementColors.FromRgb(0x1E90FF), hydrophobic = ElementColors.FromRgb(0xFF4500);
            Color32 between = ElementColors.FromRgb(0xFFFFFF);
            for (int i = 0; i < colors.Length; ++i)
            {
                if (!Residues.TryGetHydropathy(structure.GetAtom(i).ResidueName, out float hydropathy))
                    continue;
                float strength = Math.Abs(hydropathy) / Residues.GreatestHydropathy;
                colors[i] = Color32.Lerp(between, hydropathy < 0 ? hydrophilic : hydrophobic, strength);
            }
        }

        private static void FillBySequence(Structure structure, Span<Color32> colors)
        {
            // The place of each atom's residue in its chain, -1 if it is none of a protein or nucleic acid.
            var chains = new Dictionary<string, int>();
            var chainOf = new int[colors.Length];
            var placeOf = new int[colors.Length];
            var lengths = new List<int>();
            StructureAtom last = default;
            for (int i = 0; i < colors.Length; ++i)
            {
                StructureAtom atom = structure.GetAtom(i);
                placeOf[i] = -1;
                if (Residues.ClassOf(atom.ResidueName) == ResidueClass.Other)
                    continue;
                if (!chains.TryGetValue(atom.Chain, out int chain))
                {
                    chains.Add(atom.Chain, chain = chains.Count);
                    lengths.Add(0);
                }
                bool isSameResidue = last.Chain == atom.Chain && last.ResidueNumber == atom.ResidueNumber &&
                    last.InsertionCode == atom.InsertionCode && last.ResidueName == atom.ResidueName;
                if (!isSameResidue)
                    ++lengths[chain];
                chainOf[i] = chain;
                placeOf[i] = lengths[chain] - 1;
                last = atom;
            }
            for (int i = 0; i < colors.Length; ++i)
            {
                if (placeOf[i] < 0)
                    continue;
                int length = lengths[chainOf[i]];
                float along = length > 1 ? (float)placeOf[i] / (length - 1) : 0;
                colors[i] = FromHue((1 - along) * 2 / 3, 0.85f); // from blue to red
            }
        }

        // Hue from 0 (red) by 1/3 (green) and 2/3 (blue) to 1 (red again), of full value.
        private static Color32 FromHue(float hue, float saturation) => new Color32(
            Channel(hue + 1f / 3, saturation), Channel(hue, saturation), Channel(hue - 1f / 3, saturation), 255);

        private static byte Channel(float hue, float saturation)
        {
            float place = 6 * (hue - (float)Math.Floor(hue)); // a trapezium over a circle of 6
            float full = Math.Max(0, Math.Min(1, place < 3 ? place : 4 - place));
            return (byte)Math.Round(255 * (1 - saturation * (1 - full)));
        }
    }
}

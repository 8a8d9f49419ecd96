// SPDX-License-Identifier: MIT
using System;

namespace QuickSes.Editor
{
    /// <summary>
    /// The settings of a <see cref="MoleculeSource"/> or <see cref="TrajectorySource"/> besides its kind.
    /// </summary>
    [Flags]
    internal enum SourceFields
    {
        None = 0,
        Asset = 1 << 0,
        Path = 1 << 1,
        Format = 1 << 2,
        Model = 1 << 3,
        SkipWater = 1 << 4,
        SkipHydrogen = 1 << 5,
        SkipHetero = 1 << 6,
        Selection = 1 << 7,
        Radii = 1 << 8,
        ColorScheme = 1 << 9,
        Molecule = 1 << 10,
        Assembly = 1 << 11,
        AlternateLocation = 1 << 12,
        Filters = Model | SkipWater | SkipHydrogen | SkipHetero | Selection
    }

    /// <summary>What the inspector shows of a source, and in which order. Decisions only: no Editor in here.</summary>
    internal static class SourceForm
    {
        /// <summary>The names under which Unity serialises the fields, top to bottom.</summary>
        public static readonly (string Property, SourceFields Field)[] Rows =
        {
            ("_asset", SourceFields.Asset),
            ("_molecule", SourceFields.Molecule),
            ("_path", SourceFields.Path),
            ("_format", SourceFields.Format),
            ("_model", SourceFields.Model),
            ("_assembly", SourceFields.Assembly),
            ("_alternateLocation", SourceFields.AlternateLocation),
            ("_skipWater", SourceFields.SkipWater),
            ("_skipHydrogen", SourceFields.SkipHydrogen),
            ("_skipHetero", SourceFields.SkipHetero),
            ("_selection", SourceFields.Selection),
            ("_radii", SourceFields.Radii),
            ("_colorScheme", SourceFields.ColorScheme)
        };

        /// <summary>Which fields of a structure's source mean something.</summary>
        /// <param name="kind">Where the file is.</param>
        /// <param name="format">As chosen.</param>
        /// <param name="fileName">What Auto goes by; may be null.</param>
        public static SourceFields OfStructure(MoleculeSourceKind kind, StructureFormat format, string fileName)
        {
            SourceFields place = PlaceOf(kind);
            if (place == SourceFields.None)
                return SourceFields.None;
            SourceFields fields = place | SourceFields.Format | SourceFields.Radii | SourceFields.ColorScheme;
            if (format == StructureFormat.Auto && fileName != null)
                format = MoleculeFile.StructureFormatOf(fileName);
            switch (format)
            {
                case StructureFormat.Xyzr: // lines of numbers, which nothing can be filtered by
                    return fields;
                case StructureFormat.Pqr:
                case StructureFormat.Gro:
                    return fields | SourceFields.Filters;
                default:
                    return fields | SourceFields.Filters | SourceFields.Assembly | SourceFields.AlternateLocation;
            }
        }

        /// <summary>Which fields of a trajectory's source mean something.</summary>
        public static SourceFields OfTrajectory(MoleculeSourceKind kind)
        {
            SourceFields place = PlaceOf(kind);
            return place == SourceFields.None ? place : place | SourceFields.Format;
        }

        /// <summary>What the user should know about a kind; null: nothing.</summary>
        public static string HintOf(MoleculeSourceKind kind) => kind == MoleculeSourceKind.File
            ? "Builds and other machines will not find an absolute path. Put the file into Assets and choose Molecule " +
              "Asset, or, if it is large, into Assets/StreamingAssets."
            : null;

        private static SourceFields PlaceOf(MoleculeSourceKind kind)
        {
            switch (kind)
            {
                case MoleculeSourceKind.TextAsset:
                    return SourceFields.Asset;
                case MoleculeSourceKind.MoleculeAsset:
                    return SourceFields.Molecule;
                case MoleculeSourceKind.StreamingAssets:
                case MoleculeSourceKind.File:
                    return SourceFields.Path;
                default:
                    return SourceFields.None;
            }
        }
    }
}

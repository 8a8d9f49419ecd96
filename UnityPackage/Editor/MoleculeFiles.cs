// SPDX-License-Identifier: MIT
using System;
using System.IO;
using System.IO.Compression;
using System.Text;

namespace QuickSes.Editor
{
    /// <summary>Which files of a project are molecules. Decisions only: no Editor in here.</summary>
    internal static class MoleculeFiles
    {
        /// <summary>
        /// What is taken into an asset at most: it is in memory as a whole, and where it is opened as a trajectory twice.
        /// </summary>
        public const long LargestAsset = 256L << 20;

        private const string StreamingAssets = "Assets/StreamingAssets/";
        private const int HeadBytes = 4096;

        // A file may begin with many lines of any of them.
        private static readonly string[] s_records =
        {
            "ATOM  ", "AUTHOR", "CAVEAT", "CISPEP", "COMPND", "CRYST1", "DBREF ", "EXPDTA", "FORMUL", "HEADER",
            "HELIX ", "HET   ", "HETATM", "HETNAM", "HETSYN", "JRNL  ", "KEYWDS", "LINK  ", "MDLTYP", "MODEL ",
            "MODRES", "MTRIX1", "NUMMDL", "ORIGX1", "REMARK", "REVDAT", "SCALE1", "SEQADV", "SEQRES", "SHEET ",
            "SITE  ", "SOURCE", "SPRSDE", "SSBOND", "TITLE ", "USER  "
        };

        /// <summary>Whether a name is that of a trajectory and of nothing else.</summary>
        public static bool IsTrajectory(string fileName)
        {
            TrajectoryFormat format = MoleculeFile.TrajectoryFormatOf(fileName);
            return format != TrajectoryFormat.Auto && format != TrajectoryFormat.Pdb;
        }

        /// <summary>Whether it lies where files stay as they are and are found by their paths.</summary>
        /// <param name="assetPath">From "Assets/" on.</param>
        public static bool IsStreamed(string assetPath) =>
            assetPath.StartsWith(StreamingAssets, StringComparison.OrdinalIgnoreCase);

        /// <summary>
        /// Whether a file whose last extension others use, too, is a molecule: ".pdb" is also a debug database, and ".gz"
        /// is anything. Looks at the beginning of it; files that can't be read are none.
        /// </summary>
        public static bool IsMolecule(string path)
        {
            bool isPacked = path.EndsWith(".gz", StringComparison.OrdinalIgnoreCase);
            StructureFormat format = MoleculeFile.StructureFormatOf(Path.GetFileName(path));
            if (format == StructureFormat.Auto && !IsTrajectory(Path.GetFileName(path)))
                return false;
            try
            {
                using (Stream file = File.OpenRead(path))
                using (Stream content = isPacked ? new GZipStream(file, CompressionMode.Decompress) : file)
                    return Matches(Head(content), format);
            }
            catch (Exception exception) when (exception is IOException || exception is InvalidDataException ||
                exception is UnauthorizedAccessException)
            {
                return false;
            }
        }

        private static bool Matches(ReadOnlySpan<byte> head, StructureFormat format)
        {
            if (format == StructureFormat.Auto) // of a trajectory, which the extension before ".gz" tells
                return head.Length > 0;
            if (head.IndexOf((byte)0) >= 0)
                return false;
            if (format != StructureFormat.Pdb)
                return head.Length > 0;
            foreach (string line in Encoding.ASCII.GetString(head).Split('\n'))
                foreach (string record in s_records)
                    if (line.StartsWith(record, StringComparison.Ordinal))
                        return true;
            return false;
        }

        private static ReadOnlySpan<byte> Head(Stream content)
        {
            var head = new byte[HeadBytes];
            int length = 0;
            for (int count = -1; count != 0 && length < head.Length; length += count)
                count = content.Read(head, length, head.Length - length);
            return new ReadOnlySpan<byte>(head, 0, length);
        }
    }
}

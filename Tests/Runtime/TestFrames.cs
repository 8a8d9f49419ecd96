// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Text;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>
    /// Frames of a small molecule with a water in its midst, and files with them, written by code that shares nothing
    /// with the readers. Positions are those of files: right-handed.
    /// </summary>
    internal static class TestFrames
    {
        public const int AtomCount = 6, WaterAtom = 2;

        /// <summary>Atoms without the water.</summary>
        public static readonly int[] WithoutWater = { 0, 1, 3, 4, 5 };

        private static readonly string[] s_names = { "N", "CA", "O", "C", "O", "CB" };

        /// <summary>In thousandths of an Å, which PDB files hold exactly.</summary>
        public static Vector3 Position(int frame, int atom) => new Vector3(
            Thousandths(1500 * atom + 120 * frame), Thousandths(700 * (atom % 2) - 35 * frame), Thousandths(11 * atom));

        private static float Thousandths(int n) => (float)(n / 1000m);

        public static Vector3[] Frame(int frame)
        {
            var positions = new Vector3[AtomCount];
            for (int i = 0; i < AtomCount; ++i)
                positions[i] = Position(frame, i);
            return positions;
        }

        public static List<Vector3[]> Frames(int count)
        {
            var frames = new List<Vector3[]>();
            for (int k = 0; k < count; ++k)
                frames.Add(Frame(k));
            return frames;
        }

        /// <summary>A PDB file, with several models if there are several frames.</summary>
        public static string Pdb(IReadOnlyList<Vector3[]> frames, string before = "")
        {
            var text = new StringBuilder(before);
            for (int k = 0; k < frames.Count; ++k)
            {
                if (frames.Count > 1)
                    text.Append($"MODEL     {k + 1,4}\n");
                for (int i = 0; i < frames[k].Length; ++i)
                    text.Append(Atom(i, i == WaterAtom ? "HOH" : "ALA", frames[k][i]));
                if (frames.Count > 1)
                    text.Append("ENDMDL\n");
            }
            return text.Append("END\n").ToString();
        }

        public static string Pdb(int frameCount, string before = "") => Pdb(Frames(frameCount), before);

        private static string Atom(int i, string residue, Vector3 p) => string.Format(CultureInfo.InvariantCulture,
            "{0,-6}{1,5}  {2,-3} {3} A{4,4}    {5,8:F3}{6,8:F3}{7,8:F3}  1.00  0.00          {8,2}\n",
            residue == "HOH" ? "HETATM" : "ATOM", i + 1, s_names[i], residue, residue == "HOH" ? 2 : 1, p.x, p.y, p.z,
            s_names[i].Substring(0, 1));

        /// <summary>CHARMM's DCD; box: edges of an orthogonal one.</summary>
        public static byte[] Dcd(IReadOnlyList<Vector3[]> frames, Vector3? box = null)
        {
            using (var stream = new MemoryStream())
            using (var writer = new BinaryWriter(stream))
            {
                var header = new int[20];
                header[0] = frames.Count;
                header[2] = 1;
                header[10] = box.HasValue ? 1 : 0;
                header[19] = 24; // CHARMM's version
                writer.Write(84);
                writer.Write(Encoding.ASCII.GetBytes("CORD"));
                foreach (int value in header)
                    writer.Write(value);
                writer.Write(84);
                writer.Write(84); // one line of title
                writer.Write(1);
                writer.Write(new byte[80]);
                writer.Write(84);
                writer.Write(4);
                writer.Write(frames[0].Length);
                writer.Write(4);
                foreach (Vector3[] frame in frames)
                {
                    if (box.HasValue)
                    {
                        writer.Write(48);
                        // Edges a, b, c, and cosines of the angles between them.
                        foreach (double value in new double[] { box.Value.x, 0, box.Value.y, 0, 0, box.Value.z })
                            writer.Write(value);
                        writer.Write(48);
                    }
                    for (int axis = 0; axis < 3; ++axis)
                    {
                        writer.Write(4 * frame.Length);
                        foreach (Vector3 position in frame)
                            writer.Write(position[axis]);
                        writer.Write(4 * frame.Length);
                    }
                }
                return stream.ToArray();
            }
        }

        /// <summary>GROMACS' XTC, which holds up to nine atoms without compression: big-endian, in nm.</summary>
        public static byte[] Xtc(IReadOnlyList<Vector3[]> frames, float picoseconds)
        {
            var bytes = new List<byte>();
            void Put(byte[] value)
            {
                if (BitConverter.IsLittleEndian)
                    Array.Reverse(value);
                bytes.AddRange(value);
            }
            for (int k = 0; k < frames.Count; ++k)
            {
                Put(BitConverter.GetBytes(1995));
                Put(BitConverter.GetBytes(frames[k].Length));
                Put(BitConverter.GetBytes(k)); // step
                Put(BitConverter.GetBytes(k * picoseconds));
                for (int i = 0; i < 9; ++i)
                    Put(BitConverter.GetBytes(0f)); // no box
                Put(BitConverter.GetBytes(frames[k].Length));
                foreach (Vector3 position in frames[k])
                    for (int axis = 0; axis < 3; ++axis)
                        Put(BitConverter.GetBytes(position[axis] / 10));
            }
            return bytes.ToArray();
        }
    }

    /// <summary>A folder that goes with the test.</summary>
    internal sealed class TestFolder : IDisposable
    {
        public TestFolder()
        {
            Root = Path.Combine(Path.GetTempPath(), Path.GetRandomFileName());
            Directory.CreateDirectory(Root);
        }

        public string Root { get; }

        public string Write(string name, byte[] bytes)
        {
            string path = Path.Combine(Root, name);
            File.WriteAllBytes(path, bytes);
            return path;
        }

        public string Write(string name, string text) => Write(name, Encoding.ASCII.GetBytes(text));

        public void Dispose()
        {
            BackgroundThread.SendAllAway(); // some systems delete no open files
            Directory.Delete(Root, true);
        }
    }
}

// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// A structure that was read, and what surfaces take of it: positions in Unity's space, and colours. One thread at
    /// a time; makes garbage.
    /// </summary>
    internal sealed class LoadedStructure : IDisposable
    {
        private sealed class Disposal : BackgroundThread
        {
            private readonly LoadedStructure _loaded;

            private Disposal(LoadedStructure loaded)
                : base("QuickSES disposal")
            {
                _loaded = loaded;
            }

            public static bool TryBegin(LoadedStructure loaded)
            {
                try
                {
                    new Disposal(loaded).Start();
                    return true;
                }
                catch (Exception)
                {
                    return false;
                }
            }

            public override void SendAway()
            {
            }

            protected override void Run() => _loaded.Dispose();
        }

        private readonly UnmanagedBuffer<Vector3> _positions = new UnmanagedBuffer<Vector3>();
        private readonly UnmanagedBuffer<Color32> _colors = new UnmanagedBuffer<Color32>();

        /// <param name="structure">Taken over.</param>
        /// <param name="colorScheme">How its atoms are coloured.</param>
        public LoadedStructure(Structure structure, AtomColorScheme colorScheme)
        {
            Structure = structure;
            UnitySpace.FromFile(structure.Positions, _positions.Resize(structure.AtomCount));
            AtomsHash = HashOfAtoms(structure);
            Color(colorScheme);
        }

        /// <summary>Open until Dispose, unless somebody else took it: null then.</summary>
        public Structure Structure { get; private set; }

        /// <summary><see cref="HashOfAtoms"/> of the structure.</summary>
        public int AtomsHash { get; }

        /// <summary>The same for the same atoms at the same places, as long as the program runs.</summary>
        public static int HashOfAtoms(Structure structure)
        {
            var hash = new HashCode();
            foreach (int bits in MemoryMarshal.Cast<float, int>(structure.Positions))
                hash.Add(bits);
            foreach (int bits in MemoryMarshal.Cast<float, int>(structure.Radii))
                hash.Add(bits);
            return hash.ToHashCode();
        }

        /// <summary>From now on it is the caller's to dispose of.</summary>
        public Structure TakeStructure()
        {
            Structure taken = Structure;
            Structure = null;
            return taken;
        }

        public ReadOnlySpan<Vector3> Positions => _positions.Span;

        public ReadOnlySpan<float> Radii => Structure.Radii;

        /// <summary>Transparent black stands for the base colour, whatever that is later.</summary>
        public ReadOnlySpan<Color32> Colors => _colors.Span;

        /// <summary>Colours anew, on the calling thread.</summary>
        public void Color(AtomColorScheme colorScheme) =>
            AtomColors.Fill(Structure, colorScheme, default, _colors.Resize(Structure.AtomCount));

        /// <summary>
        /// Has it disposed of by a thread of its own, since freeing what the library holds of a large molecule takes some
        /// milliseconds. Where the domain ends, or there are no threads left, it happens at once.
        /// </summary>
        public void DisposeInBackground()
        {
            if (BackgroundThread.IsDomainEnding || !Disposal.TryBegin(this))
                Dispose();
        }

        public void Dispose()
        {
            _positions.Dispose();
            _colors.Dispose();
            Structure?.Dispose();
        }
    }
}

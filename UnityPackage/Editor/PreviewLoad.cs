// SPDX-License-Identifier: MIT
using System;

namespace QuickSes.Editor
{
    /// <summary>Reads a <see cref="StructurePreview"/> while the Editor goes on. Main thread.</summary>
    internal sealed class PreviewLoad : IDisposable
    {
        private StructureLoad _load; // null: it is over

        /// <param name="source">Is copied.</param>
        public PreviewLoad(MoleculeSource source)
        {
            MoleculeSource copy = source.Copy();
            copy.ColorScheme = AtomColorScheme.Uniform; // nobody sees colours
            if (source.TryFind(out MoleculeFile file, out QuickSesError error))
                _load = new StructureLoad(file, copy);
            else
                Preview = StructurePreview.OfError(error);
        }

        /// <summary>null: it is being read.</summary>
        public StructurePreview Preview { get; private set; }

        /// <summary>From 0 to 1.</summary>
        public float Progress => _load == null ? 1 : _load.Progress;

        /// <summary>To be called each frame. Whether there is a preview.</summary>
        public bool Tick()
        {
            if (_load == null || !_load.Tick())
                return Preview != null;
            if (_load.TryTake(out LoadedStructure[] structures, out QuickSesError error))
            {
                _load.File.Dispose();
                Preview = StructurePreview.Of(structures[0].Structure);
                structures[0].DisposeInBackground();
            }
            else
            {
                Preview = StructurePreview.OfError(error);
            }
            _load = null;
            return true;
        }

        /// <summary>Nothing comes of it any more.</summary>
        public void Dispose()
        {
            _load?.Dispose();
            _load = null;
        }
    }
}

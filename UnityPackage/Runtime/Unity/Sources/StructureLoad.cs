// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>
    /// Reads structures of one file on a thread of its own, and makes of them what surfaces take, so that nothing is
    /// left to the main thread but to copy that. Main thread, but for what its thread does.
    /// </summary>
    internal sealed class StructureLoad : BackgroundThread, IDisposable
    {
        // How far it is once the file may be read by the thread, once a structure is read, and once it is coloured,
        // about as long as these take. The library reads a structure in one call, during which it does not tell.
        private const float DetachedAt = 0.1f, ReadAt = 0.8f;

        private readonly MoleculeFile _file;
        private readonly MoleculeSource[] _sources;
        private bool _isStarted;
        private volatile float _progress;

        // Guarded by _gate.
        private readonly object _gate = new object();
        private bool _isStopping, _isFinished;
        private LoadedStructure[] _structures;
        private QuickSesError _error;
        private int _failed = -1;

        /// <param name="file">Taken over, until <see cref="File"/> is asked for.</param>
        /// <param name="sources">Of that file, with filters and colours each. Taken over.</param>
        public StructureLoad(MoleculeFile file, params MoleculeSource[] sources)
            : base("QuickSES structure")
        {
            _file = file;
            _sources = sources;
        }

        /// <summary>From 0 to 1, in steps.</summary>
        public float Progress => _progress;

        /// <summary>The file, for others to read on once it is finished; not this one's any more.</summary>
        public MoleculeFile File => _file;

        /// <summary>Which of the sources could not be read, once it is finished; -1: none.</summary>
        public int FailedSource => _failed;

        /// <summary>What is left to the main thread; to be called each frame. Whether it is finished.</summary>
        public bool Tick()
        {
            lock (_gate)
            {
                if (_isFinished)
                    return true;
            }
            if (_isStarted)
                return false;
            // Players for the web have no library, and no threads that could find that out.
            if (!NativeLibraryCheck.IsUsable(out string reason))
                return Fail(new QuickSesError(QuickSesStatus.BackendUnavailable, reason));
            if (!_file.TryDetach(out QuickSesError error))
                return Fail(error);
            _progress = DetachedAt * _file.DetachedPart;
            if (!_file.IsDetached)
                return false;
            _isStarted = true;
            try
            {
                Start();
            }
            catch (Exception exception) // there are no threads left, say
            {
                return Fail(Describe(exception));
            }
            return false;
        }

        /// <summary>Does all of it on the calling thread, instead of <see cref="Tick"/>.</summary>
        public void RunHere()
        {
            _isStarted = true;
            Run();
        }

        /// <summary>Once it is finished: what was read, in the order of the sources, which is the caller's.</summary>
        public bool TryTake(out LoadedStructure[] structures, out QuickSesError error)
        {
            lock (_gate)
            {
                structures = _structures;
                error = _error;
                _structures = null;
            }
            return structures != null;
        }

        /// <summary>Lets go of everything. What is being read is read to its end, but nobody learns of it.</summary>
        public void Dispose()
        {
            SendAway();
            if (!_isStarted)
                _file.Dispose();
            if (!TryTake(out LoadedStructure[] structures, out _))
                return;
            foreach (LoadedStructure each in structures)
                each.DisposeInBackground();
            _file.Dispose();
        }

        public override void SendAway()
        {
            lock (_gate)
                _isStopping = true;
        }

        protected override void Run()
        {
            var structures = new LoadedStructure[_sources.Length];
            QuickSesError error = default;
            try
            {
                for (int k = 0; k < structures.Length && error.Status == QuickSesStatus.Ok && !IsStopping; ++k)
                {
                    structures[k] = Read(_sources[k], k, out error);
                    _failed = error.Status == QuickSesStatus.Ok ? -1 : k;
                }
            }
            catch (Exception exception)
            {
                error = Describe(exception);
            }
            Finish(structures, error);
        }

        private LoadedStructure Read(MoleculeSource source, int k, out QuickSesError error)
        {
            float part = (1 - DetachedAt) / _sources.Length, from = DetachedAt + k * part;
            _progress = from;
            if (!source.TryOpen(_file, out Structure structure, out error))
                return null;
            _progress = from + ReadAt * part;
            try
            {
                var loaded = new LoadedStructure(structure, source.ColorScheme);
                _progress = from + part;
                return loaded;
            }
            catch
            {
                structure.Dispose();
                throw;
            }
        }

        private bool Fail(in QuickSesError error)
        {
            Finish(null, error);
            return true;
        }

        private void Finish(LoadedStructure[] structures, QuickSesError error)
        {
            bool isWanted;
            lock (_gate)
            {
                isWanted = !_isStopping && error.Status == QuickSesStatus.Ok;
                _structures = isWanted ? structures : null;
                _error = error;
                _isFinished = true;
            }
            if (isWanted)
                return;
            Dispose(structures);
            _file.Dispose();
        }

        private bool IsStopping
        {
            get
            {
                lock (_gate)
                    return _isStopping;
            }
        }

        private static void Dispose(LoadedStructure[] structures)
        {
            if (structures == null)
                return;
            foreach (LoadedStructure each in structures)
                each?.Dispose();
        }
    }
}

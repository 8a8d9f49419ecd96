// SPDX-License-Identifier: MIT
// Each event in C#, and right after it in what is wired in the inspector. Handlers may destroy the player.
using System;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class TrajectoryPlayer
    {
        [SerializeField] private PlayerEvents _events = new PlayerEvents();

        private readonly Listeners _loaded = new Listeners();
        private readonly Listeners<int> _frameShown = new Listeners<int>();
        private readonly Listeners _looped = new Listeners();
        private readonly Listeners _finished = new Listeners();
        private readonly Listeners<Action<int, QuickSesError>, (int Frame, QuickSesError Error)> _failed =
            new Listeners<Action<int, QuickSesError>, (int Frame, QuickSesError Error)>(
                (handler, what) => handler(what.Frame, what.Error));

        /// <summary>The same events as UnityEvents, which can be wired in the inspector.</summary>
        public PlayerEvents Events => _events;

        private void RaiseLoaded()
        {
            _loaded.Tell(this);
            WiredListeners.Tell(_events.Loaded, this);
        }

        private void RaiseFrameShown(int frame)
        {
            _frameShown.Tell(frame, this);
            WiredListeners.Tell(_events.FrameShown, frame, this);
        }

        private void RaiseLooped()
        {
            _looped.Tell(this);
            WiredListeners.Tell(_events.Looped, this);
        }

        private void RaiseFinished()
        {
            _finished.Tell(this);
            WiredListeners.Tell(_events.Finished, this);
        }

        private void RaiseFailed(int frame)
        {
            bool isHeard = _failed.IsAny || WiredListeners.AreAnyCalled(_events.Failed);
            if (!isHeard && (frame < 0 || !_isDamageLogged))
                Debug.LogError($"{name}: {LastError.Message}", this);
            _isDamageLogged |= frame >= 0;
            QuickSesError error = LastError;
            _failed.Tell((frame, error), this);
            WiredListeners.Tell(_events.Failed, error.Message, this);
        }
    }
}

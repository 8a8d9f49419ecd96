// SPDX-License-Identifier: MIT
// Each event in C#, and right after it in what is wired in the inspector. Handlers may destroy the player.
using UnityEngine;

namespace QuickSes
{
    public sealed partial class TrajectoryPlayer
    {
        [SerializeField] private PlayerEvents _events = new PlayerEvents();

        /// <summary>The same events as UnityEvents, which can be wired in the inspector.</summary>
        public PlayerEvents Events => _events;

        private void RaiseLoaded()
        {
            Loaded?.Invoke();
            if (this != null)
                _events.Loaded.Invoke();
        }

        private void RaiseFrameShown(int frame)
        {
            FrameShown?.Invoke(frame);
            if (this != null)
                _events.FrameShown.Invoke(frame);
        }

        private void RaiseLooped()
        {
            Looped?.Invoke();
            if (this != null)
                _events.Looped.Invoke();
        }

        private void RaiseFinished()
        {
            Finished?.Invoke();
            if (this != null)
                _events.Finished.Invoke();
        }

        private void RaiseFailed(int frame)
        {
            bool isHeard = Failed != null || _events.Failed.GetPersistentEventCount() > 0;
            if (!isHeard && (frame < 0 || !_isDamageLogged))
                Debug.LogError($"{name}: {LastError.Message}", this);
            _isDamageLogged |= frame >= 0;
            QuickSesError error = LastError;
            Failed?.Invoke(frame, error);
            if (this != null)
                _events.Failed.Invoke(error.Message);
        }
    }
}

// SPDX-License-Identifier: MIT
using System;
using UnityEngine;
using UnityEngine.Events;

namespace QuickSes
{
    /// <summary>
    /// The events of a <see cref="TrajectoryPlayer"/> for those who wire in the inspector; each comes right after the C#
    /// event of the same name. Serialised with the component. Main thread only.
    /// </summary>
    [Serializable]
    public sealed class PlayerEvents
    {
        [SerializeField, Tooltip("Frames can be shown from now on.")]
        private UnityEvent _loaded = new UnityEvent();
        [SerializeField, Tooltip("The surface was given this frame, counted from 0.")]
        private UnityEvent<int> _frameShown = new UnityEvent<int>();
        [SerializeField, Tooltip("An end was passed.")]
        private UnityEvent _looped = new UnityEvent();
        [SerializeField, Tooltip("It was played once, and is paused at the end.")]
        private UnityEvent _finished = new UnityEvent();
        [SerializeField, Tooltip("A frame is damaged, or nothing can be shown; the text says which and why. If nothing is " +
            "wired here, and no script listens, it is logged.")]
        private UnityEvent<string> _failed = new UnityEvent<string>();

        /// <summary>See <see cref="TrajectoryPlayer.Loaded"/>.</summary>
        public UnityEvent Loaded => _loaded;

        /// <summary>See <see cref="TrajectoryPlayer.FrameShown"/>.</summary>
        public UnityEvent<int> FrameShown => _frameShown;

        /// <summary>See <see cref="TrajectoryPlayer.Looped"/>.</summary>
        public UnityEvent Looped => _looped;

        /// <summary>See <see cref="TrajectoryPlayer.Finished"/>.</summary>
        public UnityEvent Finished => _finished;

        /// <summary>
        /// See <see cref="TrajectoryPlayer.Failed"/>; with the sentence, which names the frame. What is wired in the
        /// inspector and is called now (not Off, nor Runtime Only in edit mode) counts as a listener, so that nothing is
        /// logged; AddListener does not.
        /// </summary>
        public UnityEvent<string> Failed => _failed;
    }
}

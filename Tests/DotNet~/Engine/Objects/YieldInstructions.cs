// SPDX-License-Identifier: MIT
using System;
using System.Collections;
using System.Collections.Generic;

namespace UnityEngine
{
    public class YieldInstruction
    {
    }

    public sealed class Coroutine : YieldInstruction
    {
        internal MonoBehaviour Owner;
        internal IEnumerator Root;
        internal readonly Stack<IEnumerator> Routines = new Stack<IEnumerator>();
        internal double ResumeTime;
        internal Coroutine WaitsFor;
        internal bool WaitsForEndOfFrame;
        internal bool IsDone;

        internal Coroutine()
        {
        }
    }

    public sealed class WaitForSeconds : YieldInstruction
    {
        internal readonly float Seconds;

        public WaitForSeconds(float seconds) => Seconds = seconds;
    }

    public sealed class WaitForEndOfFrame : YieldInstruction
    {
    }

    public sealed class WaitForFixedUpdate : YieldInstruction
    {
    }

    public abstract class CustomYieldInstruction : IEnumerator
    {
        public abstract bool keepWaiting { get; }

        public object Current => null;

        public bool MoveNext() => keepWaiting;

        public virtual void Reset()
        {
        }
    }

    public sealed class WaitUntil : CustomYieldInstruction
    {
        private readonly Func<bool> _predicate;

        public WaitUntil(Func<bool> predicate) => _predicate = predicate;

        public override bool keepWaiting => !_predicate();
    }

    public sealed class WaitWhile : CustomYieldInstruction
    {
        private readonly Func<bool> _predicate;

        public WaitWhile(Func<bool> predicate) => _predicate = predicate;

        public override bool keepWaiting => _predicate();
    }

    public class WaitForSecondsRealtime : CustomYieldInstruction
    {
        private readonly double _end;

        public WaitForSecondsRealtime(float time)
        {
            waitTime = time;
            _end = Time.realtimeSinceStartupAsDouble + time;
        }

        public float waitTime { get; set; }

        public override bool keepWaiting => Time.realtimeSinceStartupAsDouble < _end;
    }
}

// SPDX-License-Identifier: MIT
using System;
using System.Collections;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes.EngineDouble
{
    /// <summary>Routines that scripts have started; they go on after Update.</summary>
    internal static class Coroutines
    {
        private static readonly List<Coroutine> s_routines = new List<Coroutine>();

        public static Coroutine Start(MonoBehaviour owner, IEnumerator routine)
        {
            var coroutine = new Coroutine { Owner = owner, Root = routine };
            coroutine.Routines.Push(routine);
            s_routines.Add(coroutine);
            Resume(coroutine); // Up to its first yield at once.
            return coroutine;
        }

        public static void Stop(MonoBehaviour owner, Coroutine routine)
        {
            foreach (Coroutine candidate in s_routines)
                if (ReferenceEquals(candidate, routine) && ReferenceEquals(candidate.Owner, owner))
                    candidate.IsDone = true;
        }

        public static void Stop(MonoBehaviour owner, IEnumerator routine)
        {
            foreach (Coroutine candidate in s_routines)
                if (ReferenceEquals(candidate.Root, routine) && ReferenceEquals(candidate.Owner, owner))
                    candidate.IsDone = true;
        }

        public static void StopAll(MonoBehaviour owner)
        {
            foreach (Coroutine candidate in s_routines)
                if (ReferenceEquals(candidate.Owner, owner))
                    candidate.IsDone = true;
        }

        public static void Run(bool atEndOfFrame)
        {
            int count = s_routines.Count;
            for (int i = 0; i < count; ++i)
            {
                Coroutine coroutine = s_routines[i];
                bool isDue = coroutine.WaitsForEndOfFrame == atEndOfFrame && Time.timeAsDouble >= coroutine.ResumeTime;
                if (isDue && !coroutine.IsDone && (coroutine.WaitsFor == null || coroutine.WaitsFor.IsDone))
                    Resume(coroutine);
            }

            for (int i = s_routines.Count - 1; i >= 0; --i)
                if (s_routines[i].IsDone)
                    s_routines.RemoveAt(i);
        }

        public static void Clear() => s_routines.Clear();

        private static void Resume(Coroutine coroutine)
        {
            coroutine.WaitsFor = null;
            coroutine.WaitsForEndOfFrame = false;
            while (!coroutine.IsDone)
            {
                IEnumerator routine = coroutine.Routines.Peek();
                bool goesOn;
                try
                {
                    goesOn = routine.MoveNext();
                }
                catch (Exception exception)
                {
                    Debug.LogException(exception, coroutine.Owner);
                    coroutine.IsDone = true;
                    return;
                }

                if (!goesOn)
                {
                    coroutine.Routines.Pop();
                    coroutine.IsDone |= coroutine.Routines.Count == 0;
                    continue;
                }

                switch (routine.Current)
                {
                    case IEnumerator inner:
                        coroutine.Routines.Push(inner);
                        continue;
                    case Coroutine other:
                        coroutine.WaitsFor = other;
                        return;
                    case WaitForSeconds wait:
                        coroutine.ResumeTime = Time.timeAsDouble + wait.Seconds;
                        return;
                    case WaitForEndOfFrame _:
                        coroutine.WaitsForEndOfFrame = true;
                        return;
                    default:
                        return;
                }
            }
        }
    }
}

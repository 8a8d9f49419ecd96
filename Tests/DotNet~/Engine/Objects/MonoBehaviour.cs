// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Collections;

namespace UnityEngine
{
    public class MonoBehaviour : Behaviour
    {
        /// <summary>What the life cycle knows about the script.</summary>
        internal ScriptState State { get; } = new ScriptState();

        public bool runInEditMode { get; set; }

        public bool useGUILayout { get; set; } = true;

        public Coroutine StartCoroutine(IEnumerator routine)
        {
            RequireAlive("StartCoroutine");
            if (routine == null)
                throw new NullReferenceException("routine is null");
            if (!Owner.activeInHierarchy)
            {
                Debug.LogError($"Coroutine couldn't be started because the the game object '{name}' is inactive!");
                return null;
            }

            return Coroutines.Start(this, routine);
        }

        public void StopCoroutine(Coroutine routine) => Coroutines.Stop(this, routine);

        public void StopCoroutine(IEnumerator routine) => Coroutines.Stop(this, routine);

        public void StopAllCoroutines() => Coroutines.StopAll(this);

        public static void print(object message) => Debug.Log(message);

        internal override void OnDestroying()
        {
            Lifecycle.Destroy(this);
            base.OnDestroying();
        }
    }
}

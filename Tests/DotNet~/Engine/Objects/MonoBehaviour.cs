// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;

namespace UnityEngine
{
    public class MonoBehaviour : Behaviour
    {
        /// <summary>What the life cycle knows about the script.</summary>
        internal ScriptState State { get; } = new ScriptState();

        /// <summary>Goes on in each frame after Update, until the object is inactive or gone.</summary>
        public Coroutine StartCoroutine(System.Collections.IEnumerator routine) => Coroutine.Start(this, routine);

        internal override void OnDestroying()
        {
            Lifecycle.Destroy(this);
            base.OnDestroying();
        }
    }
}

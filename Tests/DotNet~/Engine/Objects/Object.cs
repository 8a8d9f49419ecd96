// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;

namespace UnityEngine
{
    /// <summary>
    /// What is destroyed equals null from then on, and its members throw. The registry keeps objects until they are
    /// destroyed, as the engine keeps their native half.
    /// </summary>
    public class Object
    {
        private static int s_lastInstanceId;

        private readonly int _instanceId;
        private string _name = "";
        private HideFlags _hideFlags;

        public Object()
        {
            EngineThread.Require("The constructor of " + GetType().Name);
            _instanceId = --s_lastInstanceId; // Negative: not loaded from a file.
            ObjectRegistry.Add(this);
        }

        internal int RegistryIndex { get; set; }

        internal bool IsDestroyed { get; private set; }

        internal bool IsDestructionPending { get; set; }

        /// <summary>Whether it is in a file of the project, and in no scene.</summary>
        internal bool IsPersistent { get; set; }

        public string name
        {
            get
            {
                RequireAlive("get_name");
                return _name;
            }
            set
            {
                RequireAlive("set_name");
                _name = value ?? "";
            }
        }

        public HideFlags hideFlags
        {
            get
            {
                RequireAlive("get_hideFlags");
                return _hideFlags;
            }
            set
            {
                RequireAlive("set_hideFlags");
                _hideFlags = value;
            }
        }

        public int GetInstanceID() => _instanceId;

        public static void Destroy(Object obj)
        {
            EngineThread.Require("Destroy");
            if (obj == null || RefusesToDestroy(obj))
                return;
            if (!Application.isPlaying)
                Debug.LogError("Destroy may not be called from edit mode! Use DestroyImmediate instead.");
            else if (obj.MayBeDestroyed())
                DestructionQueue.Add(obj);
        }

        public static void DestroyImmediate(Object obj)
        {
            EngineThread.Require("DestroyImmediate");
            if (obj != null && !RefusesToDestroy(obj) && obj.MayBeDestroyed())
                obj.DestroyNow();
        }

        /// <summary>Of GameObjects and components, the latter with their GameObject.</summary>
        public static T Instantiate<T>(T original) where T : Object => Instantiate(original, null, false);

        public static T Instantiate<T>(T original, Transform parent, bool worldPositionStays) where T : Object =>
            (T)Duplication.Run(original, parent, worldPositionStays);

        public static bool operator ==(Object x, Object y) =>
            x is null || x.IsDestroyed ? y is null || y.IsDestroyed : ReferenceEquals(x, y);

        public static bool operator !=(Object x, Object y) => !(x == y);

        public override bool Equals(object other) => other is null || other is Object ? this == (Object)other : false;

        public override int GetHashCode() => _instanceId;

        public override string ToString() => IsDestroyed ? "null" : $"{_name} ({GetType().FullName})";

        /// <summary>Throws where the engine would: on another thread, and when the object was destroyed.</summary>
        internal void RequireAlive(string member)
        {
            EngineThread.Require(member);
            if (IsDestroyed)
                throw new MissingReferenceException($"The object of type '{GetType().Name}' has been destroyed but " +
                    "you are still trying to access it.");
        }

        internal void DestroyNow()
        {
            if (IsDestroyed)
                return;
            OnDestroying();
            if (IsDestroyed)
                return;
            IsDestroyed = true;
            ObjectRegistry.Remove(this);
        }

        /// <summary>False, with an error in the log, for a component that another one requires.</summary>
        internal virtual bool MayBeDestroyed() => true;

        private static bool RefusesToDestroy(Object obj)
        {
            if (obj.IsPersistent)
                Debug.LogError("Destroying assets is not permitted to avoid data loss.");
            return obj.IsPersistent;
        }

        /// <summary>The last moment at which the object is alive.</summary>
        internal virtual void OnDestroying()
        {
        }
    }
}

// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;

namespace UnityEngine
{
    public class ScriptableObject : Object
    {
        public static T CreateInstance<T>() where T : ScriptableObject => (T)CreateInstance(typeof(T));

        public static ScriptableObject CreateInstance(Type type)
        {
            var instance = (ScriptableObject)Activator.CreateInstance(type, true);
            MessageTable table = MessageTable.Of(type);
            table.Send(instance, Message.Awake);
            table.Send(instance, Message.OnEnable);
            return instance;
        }

        internal override void OnDestroying()
        {
            MessageTable table = MessageTable.Of(GetType());
            table.Send(this, Message.OnDisable);
            table.Send(this, Message.OnDestroy);
        }
    }
}

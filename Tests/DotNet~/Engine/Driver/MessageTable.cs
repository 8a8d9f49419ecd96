// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Reflection;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble
{
    internal enum Message
    {
        Awake, OnEnable, Reset, OnValidate, Start, Update, OnDidApplyAnimationProperties, LateUpdate, OnGUI,
        OnApplicationQuit, OnDisable, OnDestroy, Count
    }

    /// <summary>
    /// Which messages a type has, and what its attributes say: found once per type, so that sending allocates nothing.
    /// </summary>
    internal sealed class MessageTable
    {
        private abstract class Receiver
        {
            public abstract void Invoke(Object target);
        }

        private sealed class Receiver<T> : Receiver where T : Object
        {
            private readonly Action<T> _method;

            public Receiver(MethodInfo method) => _method = (Action<T>)method.CreateDelegate(typeof(Action<T>));

            public override void Invoke(Object target) => _method((T)target);
        }

        private const BindingFlags Declared =
            BindingFlags.DeclaredOnly | BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;

        private static readonly Dictionary<Type, MessageTable> s_tables = new Dictionary<Type, MessageTable>();

        private readonly Receiver[] _receivers = new Receiver[(int)Message.Count];

        private MessageTable(Type type)
        {
            for (Message message = 0; message < Message.Count; ++message)
            {
                MethodInfo method = FindMethod(type, message.ToString());
                if (method != null && method.ReturnType == typeof(void))
                    _receivers[(int)message] = (Receiver)Activator.CreateInstance(
                        typeof(Receiver<>).MakeGenericType(method.DeclaringType), method);
            }

            ExecutionOrder = type.GetCustomAttribute<DefaultExecutionOrder>(true)?.order ?? 0;
            RunsInEditMode = type.IsDefined(typeof(ExecuteAlways), true);
            SingleType = FindSingleType(type);
            var required = new List<Type>();
            foreach (RequireComponent attribute in type.GetCustomAttributes(typeof(RequireComponent), true))
                required.AddRange(attribute.Types);
            RequiredTypes = required.ToArray();
        }

        public bool RunsInEditMode { get; }

        /// <summary>Lower ones come first, of all that are told the same.</summary>
        public int ExecutionOrder { get; }

        /// <summary>The type of which one GameObject has one component at most, or null.</summary>
        public Type SingleType { get; }

        public Type[] RequiredTypes { get; }

        public static MessageTable Of(Type type)
        {
            if (!s_tables.TryGetValue(type, out MessageTable table))
                s_tables[type] = table = new MessageTable(type);
            return table;
        }

        /// <summary>What the method throws goes to the log, and the engine goes on.</summary>
        public void Send(Object target, Message message)
        {
            Receiver receiver = _receivers[(int)message];
            if (receiver == null)
                return;
            try
            {
                receiver.Invoke(target);
            }
            catch (Exception exception)
            {
                Debug.LogException(exception, target);
            }
        }

        // The most derived one, private or not.
        private static MethodInfo FindMethod(Type type, string name)
        {
            for (Type at = type; at != null && at != typeof(MonoBehaviour) && at != typeof(Object); at = at.BaseType)
            {
                MethodInfo method = at.GetMethod(name, Declared, null, Type.EmptyTypes, null);
                if (method != null)
                    return method;
            }

            return null;
        }

        private static Type FindSingleType(Type type)
        {
            if (typeof(Renderer).IsAssignableFrom(type))
                return typeof(Renderer);
            if (type == typeof(MeshFilter) || type == typeof(Transform) || type == typeof(Camera))
                return type;
            for (Type at = type; at != null; at = at.BaseType)
                if (at.IsDefined(typeof(DisallowMultipleComponent), false))
                    return at;
            return null;
        }
    }
}

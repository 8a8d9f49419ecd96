// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Reflection;
using System.Threading;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// What the engine does on its own, done when a test says so. All of it runs on the calling thread, which becomes
    /// the main thread with <see cref="Reset"/>.
    /// </summary>
    public static class Engine
    {
        private static readonly Stopwatch s_clock = Stopwatch.StartNew();
        private static double s_lastFrame;

        /// <summary>Before the scripts are taken down for a reload of the domain.</summary>
        public static event Action BeforeReload;

        /// <summary>Where Animators and Timelines move things in a frame: after Update, before LateUpdate.</summary>
        public static event Action Animating;

        /// <summary>At each <see cref="Reset"/>.</summary>
        internal static event Action Resetting;

        /// <summary>The Editor's part of a frame, if there is an Editor: whether scripts run in it.</summary>
        internal static Func<bool> BeginFrame { get; set; }

        /// <summary>Whether each frame ends with <see cref="MeshCheck"/> on the meshes that changed.</summary>
        public static bool ChecksMeshes { get; set; } = true;

        /// <summary>Objects of a type, or of one derived from it, that have not been destroyed.</summary>
        public static int LiveObjects<T>() where T : Object => ObjectRegistry.CountOf<T>();

        /// <summary>The same themselves.</summary>
        public static List<T> AllObjects<T>() where T : Object
        {
            var found = new List<T>();
            foreach (Object item in ObjectRegistry.Objects)
                if (item is T one)
                    found.Add(one);
            return found;
        }

        /// <summary>
        /// A new, empty scene in play mode, at time 0. What there was is destroyed as if the game had ended, meshes and
        /// materials included; statics of the code under test stay as they are.
        /// </summary>
        public static void Reset()
        {
            EngineThread.Adopt();
            Resetting?.Invoke();
            DestroyScene();
            RenderThread.Reset();
            Coroutine.Reset();
            SystemInfo.GraphicsDevice = UnityEngine.Rendering.GraphicsDeviceType.OpenGLCore;
            for (int i = ObjectRegistry.Objects.Count; i-- > 0; i = Math.Min(i, ObjectRegistry.Objects.Count))
                ObjectRegistry.Objects[i].DestroyNow();
            DestructionQueue.Clear();
            GraphicsMemory.Refusal = null;
            Resources.Assets.Clear();
            Time.Reset();
            BeforeReload = null;
            Animating = null;
            Application.isPlaying = true;
            ChecksMeshes = true;
            s_lastFrame = s_clock.Elapsed.TotalSeconds;
        }

        /// <summary>A frame that takes what has passed since the last one, at least a millisecond.</summary>
        public static void Frame()
        {
            Thread.Sleep(1);
            double now = s_clock.Elapsed.TotalSeconds;
            double passed = now - s_lastFrame;
            s_lastFrame = now;
            Frame(passed);
        }

        /// <summary>
        /// A frame that takes this long, in seconds, as far as the scripts can tell. In edit mode: one of the frames
        /// that the Editor makes when something changes.
        /// </summary>
        public static void Frame(double seconds)
        {
            EngineThread.Require("Engine.Frame");
            if (BeginFrame?.Invoke() == false)
                return;
            Time.Advance(seconds);
            Lifecycle.StartPending();
            Lifecycle.Broadcast(Message.Update);
            Coroutine.RunAll();
            Animating?.Invoke();
            Lifecycle.Broadcast(Message.LateUpdate);
            RenderThread.EndFrame();
            if (ChecksMeshes)
                MeshCheck.RunOnChanged();
            DestructionQueue.Run();
        }

        /// <summary>
        /// What an animation does to a script, in play mode or as a preview in edit mode: it writes a serialised field
        /// and says so, but does not call OnValidate.
        /// </summary>
        public static void Animate(MonoBehaviour script, string field, float value)
        {
            const BindingFlags Declared =
                BindingFlags.DeclaredOnly | BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;
            FieldInfo found = script.GetType().GetField(field, Declared);
            if (found == null || !(found.IsPublic || found.IsDefined(typeof(SerializeField), false)))
                throw new ArgumentException($"{script.GetType()} has no serialised field {field}");
            if (found.FieldType != typeof(float))
                throw new ArgumentException($"a curve gives floats, not {found.FieldType}");
            found.SetValue(script, value);
            if (script.State.IsEnabled)
                script.State.Messages.Send(script, Message.OnDidApplyAnimationProperties);
        }

        /// <summary>
        /// OnGUI of all scripts, for one event of each of the given types, or for Layout and Repaint.
        /// </summary>
        /// <returns>The labels of the last one.</returns>
        public static IReadOnlyList<string> Gui(params EventType[] types)
        {
            foreach (EventType type in types.Length > 0 ? types : new[] { EventType.Layout, EventType.Repaint })
            {
                Event.current = new Event { type = type };
                GUILayout.Labels.Clear();
                Lifecycle.Broadcast(Message.OnGUI);
            }

            Event.current = null;
            return GUILayout.Labels;
        }

        /// <summary>
        /// A reload of the domain, as scripts that run see it: OnDisable, fields that are not serialised lose their
        /// values, OnEnable. Statics: whoever has some resets them at <see cref="BeforeReload"/>.
        /// </summary>
        public static void Reload()
        {
            BeforeReload?.Invoke();
            var scripts = new List<MonoBehaviour>(Lifecycle.Enabled);
            foreach (MonoBehaviour script in scripts)
                Lifecycle.Disable(script);
            foreach (Object item in new List<Object>(ObjectRegistry.Objects))
            {
                if (!(item is MonoBehaviour script))
                    continue;
                DomainReload.ForgetFields(script);
                script.State.IsStarted = false;
            }

            foreach (MonoBehaviour script in scripts)
                if (script != null && script.isActiveAndEnabled)
                    Lifecycle.Enable(script);
        }

        /// <summary>
        /// Lets an object and those below it be a prefab that is open for editing, which does not play in play mode.
        /// </summary>
        public static void OpenAsPrefab(GameObject root) => root.IsInPrefabStage = true;

        /// <summary>
        /// Lets an object be an asset in a folder called Resources, until <see cref="Reset"/>; null: none.
        /// </summary>
        public static void PutIntoResources(string path, Object asset) => Resources.Assets[path] = asset;

        /// <summary>Edit mode with an empty scene.</summary>
        public static void EnterEditMode()
        {
            DestroyScene();
            Application.isPlaying = false;
        }

        /// <summary>
        /// From edit mode to play mode without a reload of the domain: the scene is loaded anew (here: left empty), the
        /// statics stay, methods with RuntimeInitializeOnLoadMethod are called.
        /// </summary>
        public static void EnterPlayModeWithoutReload(params Assembly[] assemblies)
        {
            DestroyScene();
            BeginToPlay(assemblies);
            Initialize(assemblies, RuntimeInitializeLoadType.AfterSceneLoad);
        }

        /// <summary>
        /// The same without a reload of the scene either: scripts that ran in edit mode keep all their fields, and are told
        /// OnDisable and OnEnable, but neither OnDestroy nor Awake; the others wake.
        /// </summary>
        public static void EnterPlayModeInTheSameScene(params Assembly[] assemblies)
        {
            foreach (MonoBehaviour script in new List<MonoBehaviour>(Lifecycle.Enabled))
                Lifecycle.Disable(script);
            BeginToPlay(assemblies);
            foreach (MonoBehaviour script in Lifecycle.InOrder(AllObjects<MonoBehaviour>()))
            {
                if (script == null)
                    continue;
                script.State.IsStarted = false;
                Lifecycle.Refresh(script);
            }
            Initialize(assemblies, RuntimeInitializeLoadType.AfterSceneLoad);
        }

        private static void BeginToPlay(Assembly[] assemblies)
        {
            Application.isPlaying = true;
            Time.Reset();
            Initialize(assemblies, RuntimeInitializeLoadType.SubsystemRegistration,
                RuntimeInitializeLoadType.AfterAssembliesLoaded, RuntimeInitializeLoadType.BeforeSplashScreen,
                RuntimeInitializeLoadType.BeforeSceneLoad);
        }

        /// <summary>
        /// The end of the program, or of play mode in the Editor, where statics and what isn't in the scene stay.
        /// </summary>
        public static void Quit()
        {
            Lifecycle.Broadcast(Message.OnApplicationQuit);
            Application.RaiseQuitting();
            DestroyScene();
        }

        private static void DestroyScene()
        {
            while (true)
            {
                GameObject root = null;
                foreach (Object item in ObjectRegistry.Objects)
                    if (root is null && item is GameObject gameObject && !gameObject.IsPersistent &&
                        gameObject.transform.parent == null)
                        root = gameObject;
                if (root is null)
                    return;
                root.DestroyNow();
            }
        }

        private static void Initialize(Assembly[] assemblies, params RuntimeInitializeLoadType[] types)
        {
            foreach (RuntimeInitializeLoadType type in types)
                foreach (Assembly assembly in assemblies)
                    Initialize(assembly, type);
        }

        private static void Initialize(Assembly assembly, RuntimeInitializeLoadType type)
        {
            const BindingFlags Static =
                BindingFlags.DeclaredOnly | BindingFlags.Static | BindingFlags.Public | BindingFlags.NonPublic;
            foreach (Type candidate in assembly.GetTypes())
            {
                if (candidate.ContainsGenericParameters)
                    continue;
                foreach (MethodInfo method in candidate.GetMethods(Static))
                    if (method.GetCustomAttribute<RuntimeInitializeOnLoadMethodAttribute>()?.loadType == type)
                        ((Action)method.CreateDelegate(typeof(Action)))();
            }
        }
    }
}

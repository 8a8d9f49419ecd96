// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;

namespace UnityEngine.SceneManagement
{
    /// <summary>Of the double there is one at a time, with everything in it that is not an asset.</summary>
    public struct Scene : IEquatable<Scene>
    {
        internal const int Only = -1000; // as in the engine, no number to rely on

        public int handle { get; internal set; }

        public int rootCount
        {
            get
            {
                int count = 0;
                foreach (Object item in ObjectRegistry.Objects)
                    if (item is GameObject gameObject && gameObject.transform.parent == null && gameObject.scene == this)
                        ++count;
                return count;
            }
        }

        public bool IsValid() => handle != 0;

        public bool Equals(Scene other) => handle == other.handle;

        public override bool Equals(object other) => other is Scene scene && Equals(scene);

        public override int GetHashCode() => handle;

        public static bool operator ==(Scene x, Scene y) => x.Equals(y);

        public static bool operator !=(Scene x, Scene y) => !x.Equals(y);
    }

    public class SceneManager
    {
        public static int sceneCount => 1;

        public static Scene GetActiveScene() => new Scene { handle = Scene.Only };

        public static Scene GetSceneAt(int index) =>
            index == 0 ? GetActiveScene() : throw new ArgumentOutOfRangeException(nameof(index));

        public static void MoveGameObjectToScene(GameObject go, Scene scene)
        {
            if (go.transform.parent != null)
                throw new ArgumentException("Gameobject is not a root in a scene");
            if (!scene.IsValid())
                throw new ArgumentException("Destination scene is not valid");
        }
    }
}

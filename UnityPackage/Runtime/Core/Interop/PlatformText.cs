// SPDX-License-Identifier: MIT
using System.Runtime.InteropServices;

namespace QuickSes.Interop
{
    /// <summary>
    /// What is said about systems without a native library, and where one can't be loaded: in players to their users, in
    /// the Editor and outside of Unity to developers.
    /// </summary>
    internal static class PlatformText
    {
        private const string Library = NativeMethods.Library;
        private const string Supported = "Windows and Linux on x86-64";

        /// <summary>What "Add package from git URL" takes: the repository of package.json, and its branch of releases.</summary>
        private const string PackageUrl = "https://example.org/quickses-for-unity.git#upm";

        /// <summary>System and processor.</summary>
        public static string Name =>
            $"{RuntimeInformation.OSDescription.Trim()} ({RuntimeInformation.ProcessArchitecture})";

        /// <summary>Why nothing is even tried in this kind of player; "" where the library is looked for.</summary>
        public static string Refusal =>
#if UNITY_EDITOR
            "";
#elif UNITY_WEBGL
            NoLibraryFor("the web");
#elif UNITY_ANDROID
            NoLibraryFor("Android");
#elif UNITY_IOS || UNITY_TVOS
            NoLibraryFor("iOS");
#elif UNITY_2021_3_OR_NEWER && !UNITY_STANDALONE
            NoLibraryFor("this device");
#else
            "";
#endif

        /// <summary>A sentence for users: what they can't have here, and where they can.</summary>
        public static string NoLibraryFor(string system) =>
            $"Molecular surfaces can't be computed on {system}: there is a native library for {Supported} only. " +
            "Surfaces that were baked into meshes are shown.";

        /// <summary>The library is missing, or can't be loaded.</summary>
        /// <param name="reason">The loader's.</param>
        public static string NotLoaded(string reason)
        {
#if UNITY_2021_3_OR_NEWER && !UNITY_EDITOR
            const bool isForDevelopers = false;
#else
            const bool isForDevelopers = true;
#endif
            return NotLoaded(reason, isForDevelopers, IsOfSupportedKind, Name);
        }

        // Those who have built a library for another system of their own have one that loads.
        internal static string NotLoaded(string reason, bool isForDevelopers, bool isOfSupportedKind, string name)
        {
            if (!isOfSupportedKind)
                return $"{NoLibraryFor(name)} ({reason})";
            string text = $"The native library {Library} can't be loaded on {name}: it is missing, or " +
                $"made for another system, or something that it needs is missing ({Supported} are " +
                "supported; on Linux, glibc 2.34 or later is needed, as in Ubuntu 22.04). ";
            if (isForDevelopers)
                text += "A checkout of the project has none until it is built (Documentation~/building.md). The " +
                    "package with its libraries: Package Manager > + > Add (Unity 6: Install) package from git URL > " +
                    $"{PackageUrl} . ";
            return text + reason;
        }

        private static bool IsOfSupportedKind => RuntimeInformation.ProcessArchitecture == Architecture.X64 &&
            (RuntimeInformation.IsOSPlatform(OSPlatform.Linux) || RuntimeInformation.IsOSPlatform(OSPlatform.Windows));
    }
}

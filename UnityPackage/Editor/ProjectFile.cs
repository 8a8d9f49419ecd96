// SPDX-License-Identifier: MIT
using System;

namespace QuickSes.Editor
{
    /// <summary>Where a file is, as seen from a project.</summary>
    internal enum ProjectFilePlace
    {
        Outside,
        Assets,
        StreamingAssets
    }

    /// <summary>A file and its place in the project. Looks at names only.</summary>
    internal readonly struct ProjectFile
    {
        private const string Assets = "Assets/";
        private const string StreamingAssets = "StreamingAssets/";

        private ProjectFile(ProjectFilePlace place, string path)
        {
            Place = place;
            Path = path;
        }

        public ProjectFilePlace Place { get; }

        /// <summary>
        /// With forward slashes. Outside: absolute; Assets: from "Assets/" on; StreamingAssets: below that folder.
        /// </summary>
        public string Path { get; }

        /// <param name="file">Absolute.</param>
        /// <param name="assetsFolder">Application.dataPath in the Editor.</param>
        /// <param name="ignoreCase">As the file system does.</param>
        public static ProjectFile Locate(string file, string assetsFolder, bool ignoreCase)
        {
            StringComparison comparison = ignoreCase ? StringComparison.OrdinalIgnoreCase : StringComparison.Ordinal;
            string full = Normalized(file);
            string assets = Normalized(assetsFolder).TrimEnd('/') + "/";
            if (!full.StartsWith(assets, comparison))
                return new ProjectFile(ProjectFilePlace.Outside, full);
            string below = full.Substring(assets.Length);
            return below.StartsWith(StreamingAssets, comparison)
                ? new ProjectFile(ProjectFilePlace.StreamingAssets, below.Substring(StreamingAssets.Length))
                : new ProjectFile(ProjectFilePlace.Assets, Assets + below);
        }

        private static string Normalized(string path) =>
            System.IO.Path.GetFullPath(path).Replace(System.IO.Path.DirectorySeparatorChar, '/');
    }
}

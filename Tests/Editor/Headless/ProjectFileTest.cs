// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.IO;

namespace QuickSes.Tests
{
    public sealed class ProjectFileTest
    {
        // Absolute on every system.
        private static readonly string s_project =
            Path.Combine(Path.GetTempPath(), "Project").Replace(Path.DirectorySeparatorChar, '/');

        [TestCase("/Assets/Molecules/1crn.pdb.bytes", ProjectFilePlace.Assets, "Assets/Molecules/1crn.pdb.bytes")]
        [TestCase("/Assets/StreamingAssets/md/run.xtc", ProjectFilePlace.StreamingAssets, "md/run.xtc")]
        [TestCase("/Assets/../Assets/a.txt", ProjectFilePlace.Assets, "Assets/a.txt")]
        // Only at the top of Assets that name is special, and only as a whole.
        [TestCase("/Assets/Sub/StreamingAssets/a.pdb", ProjectFilePlace.Assets, "Assets/Sub/StreamingAssets/a.pdb")]
        [TestCase("/Assets/StreamingAssets2/a.pdb", ProjectFilePlace.Assets, "Assets/StreamingAssets2/a.pdb")]
        public void FilesOfTheProjectAreToldByTheirFolder(string below, object place, string path)
        {
            ProjectFile found = ProjectFile.Locate(s_project + below, s_project + "/Assets", false);
            Assert.That(found.Place, Is.EqualTo(place));
            Assert.That(found.Path, Is.EqualTo(path));
        }

        [TestCase("/Assets2/a.pdb")]
        [TestCase("/Library/a.pdb")]
        [TestCase("/Assets/../a.pdb")]
        public void OthersKeepTheirAbsolutePath(string below)
        {
            ProjectFile found = ProjectFile.Locate(s_project + below, s_project + "/Assets/", false);
            Assert.That(found.Place, Is.EqualTo(ProjectFilePlace.Outside));
            Assert.That(Path.GetFullPath(found.Path), Is.EqualTo(Path.GetFullPath(s_project + below)));
        }

        [TestCase(true, ProjectFilePlace.StreamingAssets)]
        [TestCase(false, ProjectFilePlace.Outside)]
        public void CaseCountsWhereTheFileSystemTellsItApart(bool ignoreCase, object place)
        {
            ProjectFile found =
                ProjectFile.Locate(s_project + "/assets/streamingassets/a.pdb", s_project + "/Assets", ignoreCase);
            Assert.That(found.Place, Is.EqualTo(place));
        }
    }
}

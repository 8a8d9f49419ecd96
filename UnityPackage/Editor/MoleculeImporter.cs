// SPDX-License-Identifier: MIT
using System.IO;
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>
    /// Makes <see cref="MoleculeAsset"/>s of files of atoms and frames, byte for byte. Extensions that others use, too,
    /// are not its own: <see cref="MoleculeRecognition"/> assigns it to those that are molecules, so that a debug
    /// database beside a .dll stays with Unity, and no other package's importer is in its way.
    /// </summary>
    [ScriptedImporter(1,
        new[] { "cif", "mmcif", "ent", "brk", "pqr", "xyzr", "xyzrn", "gro", "xtc", "trr", "nc", "ncdf", "ncrst", "dcd" },
        new[] { "pdb", "gz" })]
    internal sealed class MoleculeImporter : ScriptedImporter
    {
        public override void OnImportAsset(AssetImportContext ctx)
        {
            if (MoleculeFiles.IsStreamed(ctx.assetPath))
                return; // it is copied as it is, and would be in builds twice
            string name = Path.GetFileName(ctx.assetPath);
            long size = new FileInfo(ctx.assetPath).Length;
            byte[] bytes = System.Array.Empty<byte>();
            if (size > MoleculeFiles.LargestAsset)
                ctx.LogImportError($"'{name}' has {size >> 20} MiB, of which an asset would be in memory as a whole; up " +
                    $"to {MoleculeFiles.LargestAsset >> 20} are taken. Put it into Assets/StreamingAssets: from there " +
                    "frames are read when they are shown.");
            else
                bytes = File.ReadAllBytes(ctx.assetPath);
            MoleculeAsset asset = MoleculeAsset.Create(name, bytes);
            ctx.AddObjectToAsset("molecule", asset);
            ctx.SetMainObject(asset);
        }
    }

    /// <summary>Has .pdb and .gz files imported as molecules if they are some, and nobody else imports them.</summary>
    internal sealed class MoleculeRecognition : AssetPostprocessor
    {
        private static void OnPostprocessAllAssets(string[] importedAssets, string[] deletedAssets,
            string[] movedAssets, string[] movedFromAssetPaths)
        {
            foreach (string path in importedAssets)
                if (IsForeign(path) && MoleculeFiles.IsMolecule(path))
                    AssetDatabase.SetImporterOverride<MoleculeImporter>(path); // imports it again
        }

        // What no importer made anything of, in folders that may be written.
        private static bool IsForeign(string path)
        {
            string extension = Path.GetExtension(path).ToLowerInvariant();
            return (extension == ".pdb" || extension == ".gz") && path.StartsWith("Assets/") &&
                !MoleculeFiles.IsStreamed(path) && AssetDatabase.GetImporterOverride(path) == null &&
                AssetDatabase.GetMainAssetTypeAtPath(path) == typeof(DefaultAsset);
        }
    }
}

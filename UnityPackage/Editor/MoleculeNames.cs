// SPDX-License-Identifier: MIT
using System.IO;

namespace QuickSes.Editor
{
    /// <summary>What new objects and assets are called.</summary>
    internal static class MoleculeNames
    {
        private const string Default = "Molecular Surface";

        /// <summary>Of a GameObject: "2k39" for "ensembles/2k39.pdb.gz.bytes".</summary>
        /// <param name="fileName">With or without folders; may be empty or null.</param>
        public static string ObjectNameOf(string fileName)
        {
            string name = Path.GetFileName(fileName ?? "");
            while (name.Length > 0)
            {
                string extension = Path.GetExtension(name).ToLowerInvariant();
                bool isWrapping = extension == ".gz" || extension == ".bytes" || extension == ".txt";
                if (!isWrapping && MoleculeFile.StructureFormatOf(name) == StructureFormat.Auto)
                    break;
                name = Path.GetFileNameWithoutExtension(name);
            }
            return string.IsNullOrWhiteSpace(name) ? Default : name;
        }

        /// <summary>Of a file in the project, without extension: what file systems refuse becomes '_'.</summary>
        public static string AssetNameOf(string objectName)
        {
            string name = (objectName ?? "").Trim();
            // What any system refuses, not only this one: projects are opened on others too.
            foreach (char refused in "<>:\"/\\|?*")
                name = name.Replace(refused, '_');
            if (name.StartsWith(".")) // which hides a file
                name = "_" + name.Substring(1);
            return name.Length == 0 ? Default : name;
        }

        /// <summary>Of the mesh asset that a baked prefab shows.</summary>
        public static string MeshBeside(string prefabPath) => Path.ChangeExtension(prefabPath, null) + " mesh.asset";

        /// <summary>Of the material asset k, from 0, of a baked prefab.</summary>
        public static string MaterialBeside(string prefabPath, int k) =>
            Path.ChangeExtension(prefabPath, null) + " material" + (k == 0 ? "" : $" {k + 1}") + ".mat";
    }
}

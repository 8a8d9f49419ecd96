// SPDX-License-Identifier: MIT
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>
    /// A file the user chose, in the form that travels best: as an asset, else relative to StreamingAssets, else by its
    /// absolute path.
    /// </summary>
    internal readonly struct ChosenFile
    {
        private static readonly string[] s_structures =
        {
            "Structures", "pdb,ent,brk,cif,mmcif,pqr,xyzr,xyzrn,gro,gz,bytes,txt", "All files", "*"
        };

        private static readonly string[] s_trajectories =
        {
            "Trajectories", "dcd,xtc,trr,nc,ncdf,ncrst,pdb,ent,brk,gz,bytes", "All files", "*"
        };

        private ChosenFile(MoleculeSourceKind kind, Object asset, string path)
        {
            Kind = kind;
            Asset = asset;
            Path = path;
        }

        public MoleculeSourceKind Kind { get; }

        /// <summary>For the kinds TextAsset and MoleculeAsset, else null.</summary>
        public Object Asset { get; }

        /// <summary>For the other kinds, else "".</summary>
        public string Path { get; }

        /// <summary>Asks for a structure; false: the user cancelled.</summary>
        public static bool AskForStructure(out ChosenFile chosen) => Ask("Structure", s_structures, out chosen);

        /// <summary>Asks for a trajectory; false: the user cancelled.</summary>
        public static bool AskForTrajectory(out ChosenFile chosen) => Ask("Trajectory", s_trajectories, out chosen);

        /// <summary>An asset the user dragged; false: it is none that a source takes.</summary>
        public static bool TryTake(Object asset, out ChosenFile chosen)
        {
            bool isMolecule = asset is MoleculeAsset;
            chosen = new ChosenFile(
                isMolecule ? MoleculeSourceKind.MoleculeAsset : MoleculeSourceKind.TextAsset, asset, "");
            return isMolecule || (asset is TextAsset && !(asset is MonoScript));
        }

        /// <param name="file">Absolute.</param>
        public static ChosenFile Of(string file)
        {
            bool ignoreCase = Application.platform != RuntimePlatform.LinuxEditor;
            ProjectFile located = ProjectFile.Locate(file, Application.dataPath, ignoreCase);
            if (located.Place == ProjectFilePlace.StreamingAssets)
                return new ChosenFile(MoleculeSourceKind.StreamingAssets, null, located.Path);
            if (located.Place == ProjectFilePlace.Assets)
            {
                var molecule = AssetDatabase.LoadAssetAtPath<MoleculeAsset>(located.Path);
                if (molecule != null)
                    return new ChosenFile(MoleculeSourceKind.MoleculeAsset, molecule, "");
                var asset = AssetDatabase.LoadAssetAtPath<TextAsset>(located.Path);
                if (asset != null)
                    return new ChosenFile(MoleculeSourceKind.TextAsset, asset, "");
            }
            return new ChosenFile(MoleculeSourceKind.File, null, file);
        }

        /// <summary>Writes it into the fields _kind, _asset, _molecule and _path below <paramref name="source"/>.</summary>
        public void AssignTo(SerializedProperty source)
        {
            source.FindPropertyRelative("_kind").intValue = (int)Kind;
            source.FindPropertyRelative("_asset").objectReferenceValue = Asset as TextAsset;
            source.FindPropertyRelative("_molecule").objectReferenceValue = Asset as MoleculeAsset;
            source.FindPropertyRelative("_path").stringValue = Path;
        }

        private static bool Ask(string title, string[] filters, out ChosenFile chosen)
        {
            string file = EditorUtility.OpenFilePanelWithFilters(title, "", filters);
            bool isChosen = !string.IsNullOrEmpty(file);
            chosen = isChosen ? Of(file) : default;
            return isChosen;
        }
    }
}

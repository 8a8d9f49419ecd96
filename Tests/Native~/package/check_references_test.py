# SPDX-License-Identifier: MIT
"""Scripts~/package/check-references must pass a right package and name each kind of fault.
   check_references_test.py PATH_OF_CHECK_REFERENCES"""

import os
import subprocess
import sys
import tempfile
import unittest

CHECK_REFERENCES = ""

HEADER = "%YAML 1.1\n%TAG !u! tag:unity3d.com,2011:\n"
GUIDS = {"Runtime/Spinner.cs": "1" * 32, "Runtime/Look.shader": "2" * 32, "Runtime/Look.mat": "3" * 32,
         "Samples~/Spin/Panel.cs": "4" * 32, "Samples~/Spin/Spin.unity": "5" * 32,
         "Samples~/Spin/data.pdb.bytes": "6" * 32}

SPINNER = """// SPDX-License-Identifier: MIT
namespace Demo
{
    /* public int _commentedOut; */
    public enum Axis { X = 1, Y, Z }

    [Serializable]
    public sealed class Source
    {
        [SerializeField] private Axis _axis = Axis.Y;
        [SerializeField, Tooltip("not (parsed); [as] code {")] private TextAsset _asset;
        private string _hidden = "};";
        public static int Count;
    }

    public abstract class Turning : MonoBehaviour
    {
        [SerializeField] protected float _speed = 1;
    }

    [RequireComponent(typeof(MeshFilter), typeof(MeshRenderer))]
    public sealed class Spinner : Turning
    {
        [SerializeField] private Source _source = new Source { };
        [SerializeField] private float[] _levels = { 2, 1 };
        [FormerlySerializedAs("_on"), SerializeField] private bool _isOn;
        [NonSerialized] public int Ticks;
        public Color32 Tint = new Color32(1, 2, 3, 4);
#if UNITY_EDITOR
        private const string Shader = "22222222222222222222222222222222";
#endif
        public float Speed { get; set; } = 2;
        public int Twice(int number) { int half = number; return half + number; }
    }
}
"""

PANEL = """namespace Demo
{
    public class Panel : MonoBehaviour
    {
        [SerializeField] private Spinner _spinner;
        [SerializeField] private Camera _camera;
    }
}
"""

SHADER = """Shader "Look"
{
    Properties
    {
        [MainColor] _Color("Tint", Color) = (1, 1, 1, 1)
        [Enum(UnityEngine.Rendering.CullMode)] _Cull("Cull", Float) = 2 // _Old("No", Float) = 1
    }
    SubShader { Pass { } }
}
"""

MATERIAL = HEADER + """--- !u!21 &2100000
Material:
  serializedVersion: 8
  m_Name: Look
  m_Shader: {fileID: 4800000, guid: 22222222222222222222222222222222, type: 3}
  m_SavedProperties:
    serializedVersion: 3
    m_TexEnvs: []
    m_Floats:
    - _Cull: 2
    m_Colors:
    - _Color: {r: 1, g: 1, b: 1, a: 1}
"""

SCENE = HEADER + """--- !u!104 &1
RenderSettings:
  m_ObjectHideFlags: 0
  m_SkyboxMaterial: {fileID: 10304, guid: 0000000000000000f000000000000000, type: 0}
--- !u!1 &100
GameObject:
  m_Component:
  - component: {fileID: 101}
  - component: {fileID: 102}
  m_Name: Camera
--- !u!4 &101
Transform:
  m_GameObject: {fileID: 100}
  m_LocalPosition: {x: 0, y: 1, z: -10}
  m_Children:
  - {fileID: 201}
  m_Father: {fileID: 0}
  m_RootOrder: 0
--- !u!20 &102
Camera:
  m_GameObject: {fileID: 100}
  near clip plane: 0.3
--- !u!1 &200
GameObject:
  m_Component:
  - component: {fileID: 201}
  - component: {fileID: 202}
  - component: {fileID: 203}
  - component: {fileID: 204}
  - component: {fileID: 205}
  m_Name: Spinner
--- !u!4 &201
Transform:
  m_GameObject: {fileID: 200}
  m_Children: []
  m_Father: {fileID: 101}
  m_RootOrder: 0
--- !u!33 &202
MeshFilter:
  m_GameObject: {fileID: 200}
  m_Mesh: {fileID: 0}
--- !u!23 &203
MeshRenderer:
  m_GameObject: {fileID: 200}
  m_Materials:
  - {fileID: 2100000, guid: 33333333333333333333333333333333, type: 2}
--- !u!114 &204
MonoBehaviour:
  m_GameObject: {fileID: 200}
  m_Enabled: 1
  m_Script: {fileID: 11500000, guid: 11111111111111111111111111111111, type: 3}
  m_Name: 
  _speed: 0.5
  _source:
    _axis: 2
    _asset: {fileID: 4900000, guid: 66666666666666666666666666666666, type: 3}
  _levels:
  - 2
  - 0.5
  _on: 1
  Tint:
    serializedVersion: 2
    rgba: 4294967295
--- !u!114 &205
MonoBehaviour:
  m_GameObject: {fileID: 200}
  m_Script: {fileID: 11500000, guid: 44444444444444444444444444444444, type: 3}
  m_Name: 
  _spinner: {fileID: 204}
  _camera: {fileID: 102}
"""


def right_package():
    """{path: text} of a small package without faults."""
    files = {"package.json": "{}", "Runtime/Demo.asmdef": '{"name": "Demo", "references": ["Unity.Mathematics"]}',
             "Samples~/Spin/Spin.asmdef": '{"name": "Demo.Spin", "references": ["Demo"]}',
             "Runtime/Spinner.cs": SPINNER, "Runtime/Look.shader": SHADER, "Runtime/Look.mat": MATERIAL,
             "Samples~/Spin/Panel.cs": PANEL, "Samples~/Spin/Spin.unity": SCENE, "Samples~/Spin/data.pdb.bytes": "",
             "Tests~/Old.cs": 'class Old { string guid = "99999999999999999999999999999999"; }',
             ".build/Broken.unity": "not a scene"}
    files.update({f"{path}.meta": f"fileFormatVersion: 2\nguid: {guid}\n" for path, guid in GUIDS.items()})
    return files


class CheckReferencesTest(unittest.TestCase):
    def run_on(self, files):
        with tempfile.TemporaryDirectory() as root:
            for path, text in files.items():
                full = os.path.join(root, path)
                os.makedirs(os.path.dirname(full), exist_ok=True)
                with open(full, "w", encoding="utf-8", newline="") as file:
                    file.write(text)
            done = subprocess.run([sys.executable, "-B", CHECK_REFERENCES, root], capture_output=True, text=True,
                                  check=False)
        return done.returncode, done.stdout + done.stderr

    def assert_fault(self, path, right, wrong, sentence, count=1):
        """With one text in place of another (its first occurrence) there is this fault; count: of all, None: any."""
        files = right_package()
        self.assertIn(right, files[path])
        files[path] = files[path].replace(right, wrong, 1)
        status, text = self.run_on(files)
        self.assertEqual(status, 1, text)
        self.assertIn(sentence, text)
        if count is not None:
            self.assertIn(f", {count} faults", text)

    def assert_scene_fault(self, right, wrong, sentence, count=1):
        self.assert_fault("Samples~/Spin/Spin.unity", right, wrong, sentence, count)

    def test_right_package(self):
        status, text = self.run_on(right_package())
        self.assertEqual((status, text), (0, "check-references: 26 references in 2 files, 0 faults\n"))

    def test_guid_of_nothing(self):
        self.assert_scene_fault("guid: 3333", "guid: 9333", "m_Materials[0]: no .meta has the GUID 9333")
        self.assert_fault("Runtime/Look.mat", "guid: 2222", "guid: 9222", "m_Shader: no .meta has the GUID 9222")
        self.assert_scene_fault("guid: 1111", "guid: 9111", "m_Script: no .meta has the GUID 9111", None)

    def test_asset_whose_meta_is_gone(self):
        files = right_package()
        del files["Samples~/Spin/data.pdb.bytes.meta"]
        status, text = self.run_on(files)
        self.assertEqual(status, 1, text)
        self.assertIn("_source._asset: no .meta has the GUID 6666", text)

    def test_file_id_that_does_not_suit_the_asset(self):
        self.assert_scene_fault("fileID: 4900000", "fileID: 11500000",
                                "file ID 11500000, but that of Samples~/Spin/data.pdb.bytes is 4900000")
        self.assert_scene_fault("fileID: 2100000", "fileID: 2100002", "no object 2100002 in Runtime/Look.mat")

    def test_type_that_does_not_suit_the_asset(self):
        self.assert_scene_fault("3333, type: 2", "3333, type: 3", "type 3, but that of Runtime/Look.mat is 2")

    def test_assets_of_unity(self):
        self.assert_scene_fault("fileID: 10304", "fileID: 10399", "m_SkyboxMaterial: file ID 10399 of Unity's own")
        self.assert_scene_fault("f000000000000000, type: 0", "f000000000000000, type: 3", "own assets have type 0")

    def test_object_that_is_not_in_the_file(self):
        self.assert_scene_fault("_spinner: {fileID: 204}", "_spinner: {fileID: 999}", "_spinner: no object 999")

    def test_file_id_used_twice(self):
        self.assert_scene_fault("--- !u!20 &102", "--- !u!20 &1", "file ID 1 a second time", None)

    def test_class_that_is_another_one(self):
        self.assert_scene_fault("--- !u!20 &102", "--- !u!108 &102", "Camera: class 108 is Light")
        self.assert_scene_fault("--- !u!20 &102", "--- !u!9999 &102", "class 9999 is not known")

    def test_component_that_its_game_object_does_not_name(self):
        self.assert_scene_fault("  - component: {fileID: 102}\n", "",
                                "its GameObject 100 does not name it among its components")

    def test_component_of_another_game_object(self):
        self.assert_scene_fault("  - component: {fileID: 205}\n", "  - component: {fileID: 102}\n",
                                "component 102 does not name it as its m_GameObject", None)

    def test_component_named_twice(self):
        self.assert_scene_fault("  - component: {fileID: 205}\n", "  - component: {fileID: 205}\n" * 2,
                                "names a component twice")

    def test_game_object_without_transform(self):
        self.assert_scene_fault("  - component: {fileID: 101}\n  - component: {fileID: 102}\n",
                                "  - component: {fileID: 102}\n  - component: {fileID: 101}\n", "its first component")

    def test_parents_and_children(self):
        self.assert_scene_fault("  m_Children:\n  - {fileID: 201}\n", "  m_Children: []\n",
                                "its father 101 does not name it among its children")
        self.assert_scene_fault("m_Father: {fileID: 101}\n  m_RootOrder: 0", "m_Father: {fileID: 0}\n  m_RootOrder: 1",
                                "child 201 does not name it as its father")
        self.assert_scene_fault("fileID: 101}\n  m_RootOrder: 0", "fileID: 101}\n  m_RootOrder: 4",
                                "m_RootOrder 4, but it is child 0")

    def test_required_component_that_is_missing(self):
        filter_ = "--- !u!33 &202\nMeshFilter:\n  m_GameObject: {fileID: 200}\n  m_Mesh: {fileID: 0}\n"
        files = right_package()
        scene = files["Samples~/Spin/Spin.unity"]
        files["Samples~/Spin/Spin.unity"] = scene.replace(filter_, "").replace("  - component: {fileID: 202}\n", "")
        status, text = self.run_on(files)
        self.assertEqual(status, 1, text)
        self.assertIn("Spinner requires a MeshFilter beside it", text)
        self.assertIn(", 1 faults", text)

    def test_field_that_is_not_in_the_class(self):
        for name in ("_sped", "_commentedOut", "Ticks", "Speed", "Shader"):
            self.assert_scene_fault("  _speed: 0.5\n", f"  {name}: 0.5\n",
                                    f"{name}: Spinner has no serialised field of this name")

    def test_field_that_is_not_in_the_nested_class(self):
        for name in ("_hidden", "Count", "_speed"):
            self.assert_scene_fault("    _axis: 2\n", f"    {name}: 2\n", f"_source.{name}: Source has no serialised")

    def test_field_that_was_renamed_without_its_former_name(self):
        self.assert_fault("Runtime/Spinner.cs", 'FormerlySerializedAs("_on"), ', "", "_on: Spinner has no serialised")

    def test_value_that_does_not_suit_the_type(self):
        self.assert_scene_fault("_speed: 0.5", "_speed: fast", "_speed: fast is not a float")
        self.assert_scene_fault("_on: 1", "_on: 2", "_on: 2 is not a bool")
        self.assert_scene_fault("_axis: 2", "_axis: 0", "_source._axis: 0 is no value of Axis")
        self.assert_scene_fault("  - 2\n  - 0.5\n", "  - 2\n  - x\n", "_levels[1]: x is not a float")
        self.assert_scene_fault("    serializedVersion: 2\n    rgba: 4294967295", "    r: 1", "Tint: not a Color32")

    def test_object_that_does_not_suit_the_type(self):
        self.assert_scene_fault("_spinner: {fileID: 204}", "_spinner: {fileID: 205}",
                                "_spinner: refers to a Panel, not a Spinner")
        self.assert_scene_fault("_camera: {fileID: 102}", "_camera: {fileID: 101}",
                                "_camera: refers to a Transform, not a Camera")

    def test_script_without_a_class_of_its_name(self):
        self.assert_fault("Samples~/Spin/Panel.cs", "class Panel", "class Window", "Panel.cs has no class Panel")
        self.assert_fault("Samples~/Spin/Panel.cs", "Panel : MonoBehaviour", "Panel", "neither a MonoBehaviour nor")

    def test_property_that_is_not_in_the_shader(self):
        for name in ("_Culling", "_Old"):
            self.assert_fault("Runtime/Look.mat", "_Cull", name, f"Runtime/Look.shader has no property {name}")

    def test_guid_in_a_source(self):
        self.assert_fault("Runtime/Spinner.cs", '"2222', '"9222', "Runtime/Spinner.cs: no .meta has the GUID 9222")

    def test_assembly_that_is_not_there(self):
        self.assert_fault("Samples~/Spin/Spin.asmdef", '["Demo"]', '["Demos"]', "Spin.asmdef: no assembly Demos")

    def test_text_that_unity_would_not_write(self):
        self.assert_scene_fault("%YAML 1.1\n", "", "must begin with %YAML 1.1")
        self.assert_scene_fault("  m_Name: Camera\n", "  m_Name Camera\n", "no key: m_Name Camera")
        self.assert_scene_fault("_camera: {fileID: 102}", "_camera: {fileID: 102", "a comma or a closing bracket")

    def test_folder_without_package(self):
        with tempfile.TemporaryDirectory() as root:
            done = subprocess.run([sys.executable, "-B", CHECK_REFERENCES, root], capture_output=True, text=True,
                                  check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("no package.json", done.stderr)


if __name__ == "__main__":
    CHECK_REFERENCES = os.path.abspath(sys.argv.pop(1))
    unittest.main()

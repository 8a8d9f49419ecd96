# SPDX-License-Identifier: MIT
"""Scripts~/package/check-references must pass a right package and name each kind of fault.
   check_references_test.py PATH_OF_CHECK_REFERENCES"""

import package_files

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
        [SerializeField] private bool _on;
        [SerializeField] private Color32 _tint = new Color32(1, 2, 3, 4);
        private int _ticks;
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
  m_SpotCookie: {fileID: 10001, guid: 0000000000000000e000000000000000, type: 0}
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
  _tint:
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


SCENE_PATH = "Samples~/Spin/Spin.unity"
FILTER = "--- !u!33 &202\nMeshFilter:\n  m_GameObject: {fileID: 200}\n  m_Mesh: {fileID: 0}\n"

# What is wrong: (file, text, what stands in place of its first occurrence, sentence), or of the scene the last three.
FAULTS = {
    "GUID of nothing": [
        ("guid: 3333", "guid: 9333", "m_Materials[0]: no .meta has the GUID 9333"),
        ("guid: 1111", "guid: 9111", "m_Script: no .meta has the GUID 9111"),
        ("Runtime/Look.mat", "guid: 2222", "guid: 9222", "m_Shader: no .meta has the GUID 9222")],
    "asset whose .meta is gone": [
        ("Samples~/Spin/data.pdb.bytes.meta", "guid: 6666", "guid: X", "_source._asset: no .meta has the GUID 6666")],
    "file ID that doesn't suit the asset": [
        ("fileID: 4900000", "fileID: 11500000", "no object 11500000 in Samples~/Spin/data.pdb.bytes"),
        ("fileID: 2100000", "fileID: 2100002", "no object 2100002 in Runtime/Look.mat")],
    "type that doesn't suit the asset": [
        ("3333, type: 2", "3333, type: 3", "type 3, but that of Runtime/Look.mat is 2"),
        ("6666, type: 3", "6666, type: 2", "type 2, but that of Samples~/Spin/data.pdb.bytes is 3")],
    "asset of Unity's own": [
        ("fileID: 10001", "fileID: 10399", "m_SpotCookie: no object 10399"),
        ("e000000000000000, type: 0", "e000000000000000, type: 3", "type 3, but that of")],
    "object that isn't in the file": [
        ("_spinner: {fileID: 204}", "_spinner: {fileID: 999}", "_spinner: no object 999 in " + SCENE_PATH)],
    "file ID used twice": [("--- !u!104 &1\n", "--- !u!104 &102\n", "file ID 102 a second time")],
    "class that is another one": [
        ("--- !u!20 &102", "--- !u!108 &102", "Camera: class 108 is Light"),
        ("--- !u!20 &102", "--- !u!9999 &102", "class 9999 is not known")],
    "component that its GameObject doesn't name": [
        ("  - component: {fileID: 205}\n", "", "MonoBehaviour: m_GameObject is 200, which m_Component of 200 contradicts")],
    "component without a GameObject": [
        ("205\nMonoBehaviour:\n  m_GameObject: {fileID: 200}", "205\nMonoBehaviour:\n  m_GameObject: {fileID: 0}",
         "MonoBehaviour: m_GameObject is 0, which m_Component of", 2)],
    "component of another GameObject": [
        ("  - component: {fileID: 205}\n", "  - component: {fileID: 205}\n  - component: {fileID: 102}\n",
         "Camera: m_GameObject is 100, which m_Component of 200 contradicts")],
    "component named twice": [
        ("  - component: {fileID: 205}\n", "  - component: {fileID: 205}\n" * 2, "m_Component: something is named twice")],
    "GameObject without a Transform": [
        ("  - component: {fileID: 101}\n  - component: {fileID: 102}\n",
         "  - component: {fileID: 102}\n  - component: {fileID: 101}\n", "its first component")],
    "parent that doesn't name its child": [
        ("  m_Children:\n  - {fileID: 201}\n", "  m_Children: []\n",
         "Transform: m_Father is 101, which m_Children of 101 contradicts")],
    "child that doesn't name its parent": [
        ("m_Father: {fileID: 101}", "m_Father: {fileID: 0}", "Transform: m_Father is 0, which m_Children of 101 contradicts")],
    "child in another order": [
        ("fileID: 101}\n  m_RootOrder: 0", "fileID: 101}\n  m_RootOrder: 4", "m_RootOrder 4, but it is child 0")],
    "required component that is missing": [
        (FILTER, "", "m_Component[1].component: no object 202"),
        (FILTER, FILTER.replace("33", "81").replace("MeshFilter", "AudioListener"), "Spinner requires a MeshFilter beside it")],
    "field that isn't in the class": [
        ("  _speed: 0.5\n", f"  {name}: 0.5\n", f"{name}: Spinner has no serialised field of this name")
        for name in ("_sped", "_commentedOut", "_ticks", "Speed", "Shader")],
    "field that isn't in the class of a field": [
        ("    _axis: 2\n", f"    {name}: 2\n", f"_source.{name}: Source has no serialised field")
        for name in ("_hidden", "Count", "_speed")],
    "field that was renamed": [("Runtime/Spinner.cs", " _on;", " _isOn;", "_on: Spinner has no serialised field")],
    "value that doesn't suit the type": [
        ("_speed: 0.5", "_speed: fast", "_speed: fast is no float"),
        ("_on: 1", "_on: 2", "_on: 2 is no bool"),
        ("_axis: 2", "_axis: 0", "_source._axis: 0 is no Axis"),
        ("  - 2\n  - 0.5\n", "  - 2\n  - x\n", "_levels[1]: x is no float"),
        ("  _levels:\n  - 2\n  - 0.5\n", "  _levels: 2\n", "_levels: 2 is no float[]"),
        ("    serializedVersion: 2\n    rgba: 4294967295", "    r: 1", "_tint: {'r': '1'} is no Color32")],
    "object that doesn't suit the type": [
        ("_spinner: {fileID: 204}", "_spinner: {fileID: 205}", "_spinner: Panel is no Spinner"),
        ("_camera: {fileID: 102}", "_camera: {fileID: 101}", "_camera: Transform is no Camera"),
        ("_camera: {fileID: 102}", "_camera: 102", "_camera: 102 is no Camera")],
    "script without a component of its name": [
        ("Samples~/Spin/Panel.cs", "class Panel", "class Window", "Panel.cs has no class Panel"),
        ("Samples~/Spin/Panel.cs", "Panel : MonoBehaviour", "Panel", "Panel.cs has no class Panel that is a MonoBehaviour")],
    "property that isn't in the shader": [
        ("Runtime/Look.mat", "_Cull", name, f"Runtime/Look.shader has no property {name}") for name in ("_Culling", "_Old")],
    "GUID in a source": [
        ("Runtime/Spinner.cs", '"2222', '"9222', "Runtime/Spinner.cs: no .meta has the GUID 9222")],
    "assembly that isn't there": [
        ("Samples~/Spin/Spin.asmdef", '["Demo"]', '["Demos"]', "Spin.asmdef: no assembly Demos")],
    "text that Unity wouldn't write": [
        ("%YAML 1.1\n", "", "must begin with %YAML 1.1"),
        ("  m_Father: {fileID: 0}\n", "  m_Father {fileID: 0}\n", SCENE_PATH + ":13: not what Unity writes: m_Father {fileID is no key", 3),
        ("--- !u!104 &1\n", "--- !u!104 1\n", SCENE_PATH + ":3: not what Unity writes"),
        ("  _on: 1\n", "  _on: 1\n  _on: 0\n", "_on a second time", 3),
        ("_camera: {fileID: 102}", "_camera: {fileID: 102", "Spin.unity:66: not what Unity writes", 2)],
}


def right_package():
    """{path: text} of a small package without faults."""
    files = {"package.json": "{}", "Runtime/Demo.asmdef": '{"name": "Demo", "references": ["Unity.Mathematics"]}',
             "Samples~/Spin/Spin.asmdef": '{"name": "Demo.Spin", "references": ["Demo"]}',
             "Runtime/Spinner.cs": SPINNER, "Runtime/Look.shader": SHADER, "Runtime/Look.mat": MATERIAL,
             "Samples~/Spin/Panel.cs": PANEL, SCENE_PATH: SCENE, "Samples~/Spin/data.pdb.bytes": "",
             "Tests~/Old.cs": 'class Old { string guid = "99999999999999999999999999999999"; }',
             ".build/Broken.unity": "not a scene"}
    files.update({f"{path}.meta": f"fileFormatVersion: 2\nguid: {guid}\n" for path, guid in GUIDS.items()})
    return files


class CheckReferencesTest(package_files.ScriptTest):
    def test_right_package(self):
        self.assertEqual(self.run_on(right_package()), (0, "check-references: 26 references in 2 files, 0 faults\n"))

    def test_faults(self):
        for name, cases in FAULTS.items():
            for case in cases:
                path, right, wrong, sentence, *count = case if case[0] in right_package() else (SCENE_PATH, *case)
                with self.subTest(name, path=path, wrong=wrong):
                    files = right_package()
                    self.assertIn(right, files[path])
                    files[path] = files[path].replace(right, wrong, 1)
                    self.assert_fault(files, sentence, *count)


if __name__ == "__main__":
    package_files.main(CheckReferencesTest)

# SPDX-License-Identifier: MIT
"""Scripts~/package/check-metas must pass a right package and name each kind of fault.   check_metas_test.py PATH_OF_CHECK_METAS"""

import package_files


def meta(number, importer, folder=False, rest=""):
    return (f"fileFormatVersion: 2\nguid: {number:032x}\n" + ("folderAsset: yes\n" if folder else "") +
            f"{importer}:\n  externalObjects: {{}}\n{rest}  userData: \n  assetBundleName: \n  assetBundleVariant: \n")


def plugin(enabled, editor_os):
    """A PluginImporter's body: enabled is a set of platforms."""
    platforms = ("Editor", "Linux64", "Win64")
    text = "  serializedVersion: 2\n  isPreloaded: 0\n  platformData:\n  - first:\n      : Any\n    second:\n      enabled: 0\n      settings:\n"
    for name in platforms:
        text += f"        Exclude {name}: {0 if name in enabled else 1}\n"
    text += "  - first:\n      Any: \n    second:\n      enabled: 0\n      settings: {}\n"
    for name in platforms:
        group = "Editor" if name == "Editor" else "Standalone"
        text += f"  - first:\n      {group}: {name}\n    second:\n      enabled: {int(name in enabled)}\n      settings:\n"
        text += f"        CPU: {'x86_64' if name in enabled else 'None'}\n"
        if name == "Editor":
            text += f"        DefaultValueInitialized: true\n        OS: {editor_os}\n"
    return text


def right_package():
    """{path: text} of a small package without faults."""
    linux = plugin({"Editor", "Linux64"}, "Linux")
    return {
        "package.json": "{}", "package.json.meta": meta(1, "PackageManifestImporter"),
        "README.md": "", "README.md.meta": meta(2, "TextScriptImporter"),
        "Runtime.meta": meta(3, "DefaultImporter", folder=True),
        "Runtime/A.cs": "", "Runtime/A.cs.meta": meta(4, "MonoImporter"),
        "Runtime/libquickses.so": "", "Runtime/libquickses.so.meta": meta(5, "PluginImporter", rest=linux),
        "Runtime/quickses.dll": "",
        "Runtime/quickses.dll.meta": meta(6, "PluginImporter", rest=plugin({"Editor", "Win64"}, "Windows")),
        "Runtime/shim.c": "", "Runtime/shim.c.meta": meta(7, "PluginImporter", rest=plugin(set(), "AnyOS")),
        "Runtime/A.mat": "", "Runtime/A.mat.meta": meta(8, "NativeFormatImporter", rest="  mainObjectFileID: 2100000\n"),
        "Runtime/A.shader": "", "Runtime/A.shader.meta": meta(9, "ShaderImporter"),
        "Native~/a.cpp": "", ".build/b.cpp": "", ".gitignore": "",
    }


def package_with_sample():
    """The same with a sample, whose folder itself needs no .meta."""
    files = right_package()
    files["package.json"] = '{"samples": [{"path": "Samples~/Play"}]}'
    files["Samples~/Play/Play.unity"] = ""
    files["Samples~/Play/Play.unity.meta"] = meta(10, "DefaultImporter")
    return files


class CheckMetasTest(package_files.ScriptTest):
    def test_right_package(self):
        status, text = self.run_on(right_package())
        self.assertEqual((status, text), (0, "check-metas: 9 visible files and folders, 0 faults\n"))

    def test_right_sample(self):
        status, text = self.run_on(package_with_sample())
        self.assertEqual((status, text), (0, "check-metas: 10 visible files and folders, 0 faults\n"))

    def test_missing_meta_in_a_sample(self):
        files = package_with_sample()
        del files["Samples~/Play/Play.unity.meta"]
        self.assert_fault(files, "Samples~/Play/Play.unity: no .meta")

    def test_guid_that_a_sample_shares_with_the_package(self):
        files = package_with_sample()
        files["Samples~/Play/Play.unity.meta"] = meta(4, "DefaultImporter")
        self.assert_fault(files, "same guid as")

    def test_sample_that_is_not_there(self):
        files = right_package()
        files["package.json"] = '{"samples": [{"path": "Samples~/Play"}]}'
        self.assert_fault(files, "Samples~/Play: package.json lists this sample")

    def test_sample_in_the_folder_that_is_left_out(self):
        files = package_with_sample()
        files["Samples~.meta"] = meta(11, "DefaultImporter", folder=True)
        self.assert_fault(files, "Samples~.meta: Samples~ does not exist")

    def test_importers_of_shaders_and_materials(self):
        files = right_package()
        files["Runtime/A.shader.meta"] = meta(9, "DefaultImporter")
        self.assert_fault(files, "ShaderImporter was expected")
        files = right_package()
        files["Runtime/A.mat.meta"] = meta(8, "DefaultImporter")
        self.assert_fault(files, "NativeFormatImporter was expected")

    def test_material_without_main_object(self):
        files = right_package()
        files["Runtime/A.mat.meta"] = meta(8, "NativeFormatImporter")
        self.assert_fault(files, "A.mat.meta: needs a mainObjectFileID")

    def test_missing_meta_of_a_file_and_of_a_folder(self):
        for path in ("README.md", "Runtime/A.cs", "Runtime"):
            files = right_package()
            del files[path + ".meta"]
            self.assert_fault(files, f"{path}: no .meta")

    def test_orphan(self):
        files = right_package()
        del files["Runtime/A.cs"]
        self.assert_fault(files, "Runtime/A.cs does not exist")

    def test_meta_of_a_hidden_folder(self):
        files = right_package()
        files["Native~.meta"] = meta(12, "DefaultImporter", folder=True)
        self.assert_fault(files, "Native~.meta: Native~ does not exist")

    def test_duplicate_guid(self):
        files = right_package()
        files["README.md.meta"] = meta(4, "TextScriptImporter")
        self.assert_fault(files, "same guid as")

    def test_bad_guid(self):
        files = right_package()
        files["README.md.meta"] = meta(2, "TextScriptImporter").replace("0002", "000G")
        self.assert_fault(files, "README.md.meta: needs one guid")

    def test_wrong_importer(self):
        files = right_package()
        files["Runtime/A.cs.meta"] = meta(4, "DefaultImporter")
        self.assert_fault(files, "MonoImporter was expected")

    def test_folder_that_is_not_marked(self):
        files = right_package()
        files["Runtime.meta"] = meta(3, "DefaultImporter")
        self.assert_fault(files, "Runtime.meta: folderAsset")

    def test_carriage_returns(self):
        files = right_package()
        files["README.md.meta"] = files["README.md.meta"].replace("\n", "\r\n")
        self.assert_fault(files, "line ends must be LF")

    def test_source_that_a_player_would_compile(self):
        files = right_package()
        files["Runtime/shim.c.meta"] = meta(7, "PluginImporter", rest=plugin({"Linux64"}, "AnyOS"))
        self.assert_fault(files, "shim.c.meta: Linux64: enabled is 1, not 0")

    def test_library_on_for_another_platform(self):
        files = right_package()
        files["Runtime/libquickses.so.meta"] = meta(5, "PluginImporter", rest=plugin({"Editor", "Linux64", "Win64"}, "Linux"))
        self.assert_fault(files, "libquickses.so.meta: Win64: enabled is 1, not 0")

    def test_library_that_another_editor_would_load(self):
        files = right_package()
        files["Runtime/quickses.dll.meta"] = meta(6, "PluginImporter", rest=plugin({"Editor", "Win64"}, "Linux"))
        self.assert_fault(files, "Editor: OS is Linux, not Windows")

    def test_exclude_that_contradicts_enabled(self):
        files = right_package()
        path = "Runtime/libquickses.so.meta"
        files[path] = files[path].replace("Exclude Win64: 1", "Exclude Win64: 0")
        self.assert_fault(files, "Exclude Win64 is 0 but Win64's enabled is 0")

    def test_preloaded_library(self):
        files = right_package()
        path = "Runtime/libquickses.so.meta"
        files[path] = files[path].replace("isPreloaded: 0", "isPreloaded: 1")
        self.assert_fault(files, "isPreloaded must be 0")

    def test_folder_without_package(self):
        status, text = self.run_on({})
        self.assertEqual(status, 2)
        self.assertIn("no package.json", text)


if __name__ == "__main__":
    package_files.main(CheckMetasTest)

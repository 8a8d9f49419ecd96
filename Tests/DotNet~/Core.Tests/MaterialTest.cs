// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections.Generic;
using System.IO;
using System.Text.RegularExpressions;

/// <summary>
/// The package's materials look as its shaders say by default: a number that a material saves overrides the shader's.
/// </summary>
public sealed class MaterialTest
{
    private static readonly string s_folder = Path.Combine(Repository.Root, "UnityPackage");

    private static IEnumerable<string> Materials => Directory.GetFiles(s_folder, "*.mat", SearchOption.AllDirectories);

    [TestCaseSource(nameof(Materials))]
    public void SavedNumbersAreTheDefaultsOfTheShader(string material)
    {
        string text = File.ReadAllText(material);
        Dictionary<string, string> defaults = NumbersOf(ShaderOf(text));
        Dictionary<string, string> saved = Pairs(text, @"^    - (_\w+): (\S+)$");
        Assert.That(saved, Is.Not.Empty.And.SubsetOf(defaults));
    }

    [Test]
    public void AmbientOcclusionIsSeen()
    {
        Assert.That(Materials, Is.Not.Empty);
        foreach (string material in Materials)
            Assert.That(File.ReadAllText(material), Does.Contain("- _OcclusionStrength: 1\n"), material);
    }

    private static string ShaderOf(string material)
    {
        string guid = Regex.Match(material, "m_Shader: .*guid: ([0-9a-f]{32})").Groups[1].Value;
        foreach (string meta in Directory.GetFiles(s_folder, "*.shader.meta", SearchOption.AllDirectories))
            if (File.ReadAllText(meta).Contains(guid))
                return File.ReadAllText(Path.ChangeExtension(meta, null));
        throw new FileNotFoundException($"no shader of the package has the GUID {guid}");
    }

    // Of properties of type Float and Range.
    private static Dictionary<string, string> NumbersOf(string shader) =>
        Pairs(shader, @"\b(_\w+)\("".*"", (?:Float|Range\(.*\))\) = (\S+)");

    private static Dictionary<string, string> Pairs(string text, string pattern)
    {
        var pairs = new Dictionary<string, string>();
        foreach (Match match in Regex.Matches(text, pattern, RegexOptions.Multiline))
            pairs.Add(match.Groups[1].Value, match.Groups[2].Value);
        return pairs;
    }
}

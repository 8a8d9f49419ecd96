// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes;
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Reflection;
using System.Text.RegularExpressions;
using UnityEngine;

/// <summary>The reference of components says of each member what is so.</summary>
internal sealed class ReferenceTest
{
    private const BindingFlags Members =
        BindingFlags.Public | BindingFlags.Instance | BindingFlags.Static | BindingFlags.DeclaredOnly;

    private static readonly string s_page =
        File.ReadAllText(Path.Combine(Repository.Root, "Documentation~", "unity-components.md"));

    [TestCase(typeof(MolecularSurface))]
    [TestCase(typeof(SurfaceScheduler))]
    [TestCase(typeof(MoleculeSource))]
    [TestCase(typeof(TrajectoryPlayer))]
    public void EveryPublicMemberIsThere(Type type)
    {
        string section = Section(type.Name);
        foreach (MemberInfo member in type.GetMembers(Members))
            if (!(member is MethodBase method && method.IsSpecialName) && member.Name != nameof(MoleculeSource.IsSet))
                Assert.That(Regex.IsMatch(section, $"`{member.Name}\\b"), $"{type.Name}.{member.Name}");
    }

    [TestCase(typeof(MolecularSurface))]
    [TestCase(typeof(SurfaceScheduler))]
    [TestCase(typeof(MoleculeSource))]
    [TestCase(typeof(TrajectoryPlayer))]
    public void DefaultsAreThoseOfTheCode(Type type)
    {
        object made = typeof(Component).IsAssignableFrom(type) ? Component(type)
            : type.IsAbstract ? null : Activator.CreateInstance(type);
        int compared = 0;
        foreach ((string name, string told) in Defaults(Section(type.Name)))
        {
            PropertyInfo property = type.GetProperty(name, Members);
            Assert.That(property, Is.Not.Null, $"{type.Name}.{name}");
            string expected = Told(property.GetValue(made));
            if (expected == null)
                continue;
            Assert.That(told.Trim('`'), Does.Match($"^{Regex.Escape(expected)}(?![\\w.])"), name);
            ++compared;
        }
        Assert.That(compared, Is.GreaterThanOrEqualTo(3));
    }

    [Test]
    public void EveryColourSchemeIsThere()
    {
        foreach (string scheme in Enum.GetNames(typeof(AtomColorScheme)))
            Assert.That(s_page, Does.Contain($"| `{scheme}` |"));
    }

    private static object Component(Type type)
    {
        var owner = new GameObject();
        owner.SetActive(false);
        return owner.AddComponent(type);
    }

    private static string Section(string title)
    {
        Match match = Regex.Match(s_page, $"^## {title}\n.*?(?=^## |\\z)",
            RegexOptions.Multiline | RegexOptions.Singleline);
        Assert.That(match.Success, title);
        return match.Value;
    }

    // Rows of tables whose second column is headed "default": each name in the first one with what the second tells.
    private static IEnumerable<(string, string)> Defaults(string section)
    {
        bool isDefaults = false;
        foreach (string line in section.Split('\n'))
        {
            if (!line.StartsWith("|"))
            {
                isDefaults = false;
                continue;
            }
            string[] cells = line.Split('|');
            if (cells[2].Trim() == "default")
                isDefaults = true;
            else if (isDefaults && cells[2].Trim().Length > 0 && !cells[1].Contains("---"))
                foreach (Match name in Regex.Matches(cells[1], "`([A-Za-z]+)`"))
                    yield return (name.Groups[1].Value, cells[2].Trim());
        }
    }

    // null: told in words.
    private static string Told(object value)
    {
        switch (value)
        {
            case bool flag:
                return flag ? "yes" : "no";
            case float[] numbers:
                return string.Join(", ", Array.ConvertAll(numbers, n => n.ToString(CultureInfo.InvariantCulture)));
            case float _:
            case double _:
            case int _:
            case ulong _:
                return Convert.ToString(value, CultureInfo.InvariantCulture);
            case Enum choice:
                return choice.ToString();
            default:
                return null;
        }
    }
}

// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;
using System.Text.RegularExpressions;

/// <summary>A field as the header declares it and as the C compiler lays it out.</summary>
internal sealed class HeaderField
{
    public string Name, Type;
    public bool IsPointer;
    public int Offset, Size;
}

internal sealed class HeaderStruct
{
    public string Name;
    public int Size;
    public readonly List<HeaderField> Fields = new List<HeaderField>();
}

/// <summary>
/// What quickses.h and quickses_gpu.h declare. Names are read from their text; sizes, offsets and values come from a C
/// program that is made of these names, compiled and run.
/// </summary>
internal sealed class Header
{
    public readonly Dictionary<string, HeaderStruct> Structs = new Dictionary<string, HeaderStruct>();
    public readonly Dictionary<string, Dictionary<string, int>> Enums =
        new Dictionary<string, Dictionary<string, int>>();
    public readonly Dictionary<string, int> EnumSizes = new Dictionary<string, int>();
    public readonly Dictionary<string, int> Constants = new Dictionary<string, int>();

    /// <summary>By the name of the structure: its bytes after its qses_..._init.</summary>
    public readonly Dictionary<string, byte[]> Defaults = new Dictionary<string, byte[]>();

    /// <summary>Number of parameters by the name of the function.</summary>
    public readonly Dictionary<string, int> Functions = new Dictionary<string, int>();

    public static readonly Lazy<Header> Instance = new Lazy<Header>(() => new Header());

    private Header()
    {
        string text = Regex.Replace(File.ReadAllText(Repository.Header) + File.ReadAllText(Repository.GpuHeader),
            @"/\*.*?\*/", " ", RegexOptions.Singleline);
        foreach (Match constant in Regex.Matches(text, @"(?m)^#define (QSES_\w+) \d+\s*$"))
            Constants[constant.Groups[1].Value] = 0;
        text = Regex.Replace(text, @"(?m)^\s*#.*$", "");
        foreach (Match match in Regex.Matches(text, @"typedef struct (\w+) \{(.*?)\} \1;", RegexOptions.Singleline))
            Structs[match.Groups[1].Value] = ParseStruct(match.Groups[1].Value, match.Groups[2].Value);
        foreach (Match match in Regex.Matches(text, @"typedef enum (\w+) \{(.*?)\} \1;", RegexOptions.Singleline))
            Enums[match.Groups[1].Value] =
                Regex.Matches(match.Groups[2].Value, @"QSES_\w+").ToDictionary(name => name.Value, _ => 0);
        foreach (Match match in Regex.Matches(text, @"QSES_API[^;]*?(qses_\w+)\(([^;]*?)\);", RegexOptions.Singleline))
            Functions[match.Groups[1].Value] =
                match.Groups[2].Value.Trim() == "void" ? 0 : match.Groups[2].Value.Split(',').Length;
        foreach (Match match in Regex.Matches(text, @"static inline void (\w+)_init\((\w+) \*"))
        {
            Defaults[match.Groups[2].Value] = null;
            if (match.Groups[1].Value != match.Groups[2].Value)
                throw new InvalidDataException($"{match.Groups[1].Value}_init is for {match.Groups[2].Value}");
        }
        AskCompiler();
    }

    private static HeaderStruct ParseStruct(string name, string body)
    {
        var result = new HeaderStruct { Name = name };
        foreach (string declaration in body.Split(';').Select(part => part.Trim()).Where(part => part != ""))
        {
            Match match = Regex.Match(declaration, @"^(?:const )?(\w+) (.*)$", RegexOptions.Singleline);
            foreach (string declarator in match.Groups[2].Value.Split(','))
                result.Fields.Add(new HeaderField
                {
                    Type = match.Groups[1].Value,
                    IsPointer = declarator.Contains('*'),
                    Name = Regex.Match(declarator, @"\w+").Value
                });
        }
        return result;
    }

    private void AskCompiler()
    {
        var program = new StringBuilder(
            "#include <stddef.h>\n#include <stdio.h>\n#include <quickses/quickses_gpu.h>\nint main(void) {\n");
        foreach (HeaderStruct type in Structs.Values)
        {
            program.Append($"  printf(\"%d\\n\", (int)sizeof({type.Name}));\n");
            foreach (HeaderField field in type.Fields)
                program.Append($"  printf(\"%d\\n%d\\n\", (int)offsetof({type.Name}, {field.Name}), " +
                               $"(int)sizeof((({type.Name} *)0)->{field.Name}));\n");
        }
        foreach (string type in Enums.Keys)
        {
            program.Append($"  printf(\"%d\\n\", (int)sizeof({type}));\n");
            foreach (string name in Enums[type].Keys)
                program.Append($"  printf(\"%d\\n\", (int){name});\n");
        }
        foreach (string name in Constants.Keys)
            program.Append($"  printf(\"%d\\n\", (int){name});\n");
        foreach (string type in Defaults.Keys)
            program.Append($"  {{\n    {type} made;\n    size_t k;\n    memset(&made, 0xcc, sizeof made);\n" +
                           $"    {type}_init(&made);\n    for (k = 0; k < sizeof made; ++k)\n" +
                           "      printf(\"%d\\n\", (int)((const unsigned char *)&made)[k]);\n  }\n");
        program.Append("  return 0;\n}\n");

        using var folder = new TemporaryFolder();
        Repository.CompileC(program.ToString(), folder.File("layout"));
        var numbers = new Queue<int>(
            Repository.Run(folder.File("layout"), "").Split('\n', StringSplitOptions.RemoveEmptyEntries)
            .Select(line => int.Parse(line, CultureInfo.InvariantCulture)));
        foreach (HeaderStruct type in Structs.Values)
        {
            type.Size = numbers.Dequeue();
            foreach (HeaderField field in type.Fields)
            {
                field.Offset = numbers.Dequeue();
                field.Size = numbers.Dequeue();
            }
        }
        foreach (string type in Enums.Keys)
        {
            EnumSizes[type] = numbers.Dequeue();
            foreach (string name in Enums[type].Keys.ToList())
                Enums[type][name] = numbers.Dequeue();
        }
        foreach (string name in Constants.Keys.ToList())
            Constants[name] = numbers.Dequeue();
        foreach (string type in Defaults.Keys.ToList())
            Defaults[type] = Enumerable.Range(0, Structs[type].Size).Select(_ => (byte)numbers.Dequeue()).ToArray();
    }

    /// <summary>compute_ms and QSES_OUT_OF_MEMORY (after its prefix) as C# writes them.</summary>
    public static string PascalCase(string name) => string.Concat(name.Split('_').Where(word => word != "")
        .Select(word => char.ToUpperInvariant(word[0]) + word.Substring(1).ToLowerInvariant()));
}

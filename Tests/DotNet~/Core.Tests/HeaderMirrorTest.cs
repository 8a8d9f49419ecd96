// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Interop;
using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;

namespace QuickSes.Tests
{
    /// <summary>What Runtime/Core declares is what the header declares.</summary>
    public sealed class HeaderMirrorTest
    {
        private const BindingFlags InstanceFields =
            BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;

        // Name in C, prefix of the enumerators, type in C#.
        private static readonly (string C, string Prefix, Type Type)[] Enums =
        {
            ("qses_status", "QSES_", typeof(QuickSesStatus)),
            ("qses_backend", "QSES_BACKEND_", typeof(SurfaceBackend)),
            ("qses_surface", "QSES_SURFACE_", typeof(SurfaceKind)),
            ("qses_method", "QSES_METHOD_", typeof(SurfaceMethod)),
            ("qses_winding", "QSES_WINDING_", typeof(SurfaceWinding)),
            ("qses_vertex_layout", "QSES_VERTICES_", typeof(SurfaceVertexLayout)),
            ("qses_delivery", "QSES_DELIVERY_", typeof(MeshDelivery)),
            ("qses_measured_by", "QSES_MEASURED_BY_", typeof(SurfaceMeasuredBy)),
            ("qses_patch", "QSES_PATCH_", typeof(SurfacePatch)),
            ("qses_job_state", "QSES_JOB_", typeof(SurfaceJobState)),
            ("qses_structure_format", "QSES_STRUCTURE_", typeof(StructureFormat)),
            ("qses_color_scheme", "QSES_COLOR_", typeof(AtomColorScheme)),
            ("qses_trajectory_format", "QSES_TRAJECTORY_", typeof(TrajectoryFormat)),
            ("qses_graphics", "QSES_GRAPHICS_", typeof(GpuGraphics))
        };

        private static readonly Dictionary<string, Type> Numbers = new Dictionary<string, Type>
        {
            ["char"] = typeof(byte), ["uint8_t"] = typeof(byte), ["int32_t"] = typeof(int), ["uint32_t"] = typeof(uint),
            ["uint64_t"] = typeof(ulong), ["float"] = typeof(float), ["double"] = typeof(double),
            ["qses_bool"] = typeof(int), ["void"] = typeof(void)
        };

        private static Header Header => Header.Instance.Value;

        private static IEnumerable<string> StructNames() => Header.Structs.Keys;

        [Test]
        public void HeaderIsUnderstood()
        {
            // Fields that cover their structure: then none was overlooked, and later ones have a place behind all bytes
            // that older callers have.
            foreach (HeaderStruct type in Header.Structs.Values)
            {
                int end = 0;
                foreach (HeaderField field in type.Fields)
                {
                    Assert.That(field.Offset, Is.EqualTo(end), $"{type.Name}.{field.Name}");
                    end = field.Offset + field.Size;
                }
                Assert.That(type.Size, Is.EqualTo(end), type.Name);
                Assert.That(type.Fields[0].Name == "struct_size", Is.EqualTo(Header.Defaults.ContainsKey(type.Name)),
                    type.Name);
            }
            Assert.That(Header.Functions.Keys, Does.Contain("qses_compute"));
        }

        [Test]
        public void ComponentsAreLookedAtInNativeMemory() =>
            Assert.That(Unsafe.SizeOf<SurfaceComponent>(), Is.EqualTo(Header.Structs["qses_component"].Size));

        private static IEnumerable<string> StructsWithDefaults() => Header.Defaults.Keys;

        [Test]
        public void NoOtherDefaultsAreWritten() => Assert.That(
            typeof(NativeDefaults).GetMethods(BindingFlags.Static | BindingFlags.Public).Select(made => made.Name),
            Is.EquivalentTo(Header.Defaults.Keys.Select(name => MirrorName(name).Substring("Native".Length))));

        [TestCaseSource(nameof(StructsWithDefaults))]
        public void DefaultsAreThoseOfC(string name)
        {
            object made = typeof(NativeDefaults).GetMethod(MirrorName(name).Substring("Native".Length))
                .Invoke(null, null);
            Assert.That(made.GetType().Name, Is.EqualTo(MirrorName(name)));
            var bytes = new byte[Header.Structs[name].Size];
            GCHandle pinned = GCHandle.Alloc(made, GCHandleType.Pinned);
            Marshal.Copy(pinned.AddrOfPinnedObject(), bytes, 0, bytes.Length);
            pinned.Free();
            Assert.That(bytes, Is.EqualTo(Header.Defaults[name]));
        }

        [TestCaseSource(nameof(StructNames))]
        public void StructHasTheLayoutOfC(string name)
        {
            HeaderStruct native = Header.Structs[name];
            Type mirror = typeof(NativeMethods).Assembly.GetType("QuickSes.Interop." + MirrorName(name));
            Assert.That(mirror, Is.Not.Null, "no such structure in C#");
            Assert.That(mirror.IsLayoutSequential, Is.True);
            FieldInfo[] fields = mirror.GetFields(InstanceFields);
            Assert.That(fields.Select(field => field.Name),
                Is.EquivalentTo(native.Fields.Select(field => Header.PascalCase(field.Name))));
            Assert.That(ManagedSize(mirror), Is.EqualTo(native.Size), "size as C# code sees it");
            Assert.That(Marshal.SizeOf(mirror), Is.EqualTo(native.Size), "size as P/Invoke sees it");
            foreach (HeaderField field in native.Fields)
            {
                FieldInfo own = fields.Single(candidate => candidate.Name == Header.PascalCase(field.Name));
                Assert.That((int)Marshal.OffsetOf(mirror, own.Name), Is.EqualTo(field.Offset), field.Name);
                Assert.That(ManagedSize(own.FieldType), Is.EqualTo(field.Size), field.Name);
                CheckType(field, own);
            }
        }

        private static void CheckType(HeaderField field, FieldInfo own)
        {
            FixedBufferAttribute buffer = own.GetCustomAttribute<FixedBufferAttribute>();
            Type type = buffer != null ? buffer.ElementType : own.FieldType;
            Assert.That(type.IsPointer, Is.EqualTo(field.IsPointer), field.Name);
            if (type.IsPointer)
                type = type.GetElementType();
            if (Numbers.TryGetValue(field.Type, out Type number))
                Assert.That(type, Is.EqualTo(number), field.Name);
            else if (Header.Enums.ContainsKey(field.Type))
                Assert.That(type, Is.EqualTo(Enums.Single(pair => pair.C == field.Type).Type), field.Name);
            else if (buffer == null) // C# has no fixed buffers of structures; those are compared by their size
                Assert.That(type.Name, Is.EqualTo(MirrorName(field.Type)), field.Name);
        }

        private static string MirrorName(string name) => "Native" + Header.PascalCase(name.Substring("qses_".Length));

        private static int ManagedSize(Type type) => type.IsPointer
            ? IntPtr.Size
            : (int)typeof(Unsafe).GetMethod(nameof(Unsafe.SizeOf)).MakeGenericMethod(type).Invoke(null, null);

        [Test]
        public void EnumerationsHaveTheValuesOfC()
        {
            Assert.That(Enums.Select(pair => pair.C), Is.EquivalentTo(Header.Enums.Keys));
            foreach ((string c, string prefix, Type type) in Enums)
            {
                Dictionary<string, int> own = Enum.GetNames(type)
                    .ToDictionary(name => name, name => Convert.ToInt32(Enum.Parse(type, name)));
                Assert.That(own, Is.EquivalentTo(Header.Enums[c].ToDictionary(
                    pair => Header.PascalCase(pair.Key.Substring(prefix.Length)), pair => pair.Value)), c);
                // Kinds of patch never cross the border as an enumeration, only as bytes of an array.
                Assert.That(ManagedSize(Enum.GetUnderlyingType(type)),
                    Is.EqualTo(type == typeof(SurfacePatch) ? sizeof(byte) : Header.EnumSizes[c]), c);
            }
        }

        [Test]
        public void ConstantsAreThoseOfC()
        {
            Assert.That(Header.Constants["QSES_ABI_VERSION"], Is.EqualTo((int)NativeMethods.AbiVersion));
            Assert.That(Header.Constants["QSES_GPU_ABI_VERSION"], Is.EqualTo((int)NativeMethods.GpuAbiVersion));
            Assert.That(Header.Constants["QSES_MAX_LEVELS"], Is.EqualTo(NativeSettings.MaxLevels));
            Assert.That(Header.Constants["QSES_REMEMBERED_SERIES"], Is.EqualTo(NativeSettings.RememberedSeries));
            Assert.That(Header.Constants["QSES_MAX_STAGES"], Is.EqualTo(NativeReport.MaxStages));
            Assert.That(Header.Structs["qses_stage_time"].Size, Is.EqualTo(NativeReport.StageTimeBytes));
        }

        [Test]
        public void EveryFunctionIsDeclaredAndExported()
        {
            MethodInfo[] methods = typeof(NativeMethods).GetMethods(BindingFlags.Static | BindingFlags.Public)
                .Where(method => method.GetCustomAttribute<DllImportAttribute>() != null).ToArray();
            Assert.That(methods.Select(method => method.Name),
                Is.EquivalentTo(Header.Functions.Keys.Where(name => name != "qses_set_progress_callback")));
            foreach (MethodInfo method in methods)
            {
                Assert.That(method.GetParameters().Length, Is.EqualTo(Header.Functions[method.Name]), method.Name);
                Assert.That(method.GetCustomAttribute<DllImportAttribute>().CallingConvention,
                    Is.EqualTo(CallingConvention.Cdecl));
                Assert.That(NativeLibrary.TryGetExport(NativeLibrarySetup.Library, method.Name, out _), Is.True,
                    method.Name);
            }
        }
    }
}

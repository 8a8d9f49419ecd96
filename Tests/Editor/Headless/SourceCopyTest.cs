// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Linq;
using System.Reflection;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>A field that is added to a source is copied with it, and makes it another source.</summary>
    public sealed class SourceCopyTest
    {
        private const string Colors = "_colorScheme"; // not a matter of which atoms are read

        [Test]
        public void StructureSourcesAreCopiedAndComparedByAllFields()
        {
            foreach (FieldInfo field in FieldsOf(typeof(MoleculeSource)))
            {
                var changed = new MoleculeSource();
                field.SetValue(changed, OtherThan(field.GetValue(changed), field.FieldType));
                Assert.That(changed.IsSameAs(new MoleculeSource()), Is.EqualTo(field.Name == Colors), field.Name);
                var copy = new MoleculeSource();
                copy.CopyFrom(changed);
                Assert.That(field.GetValue(copy), Is.EqualTo(field.GetValue(changed)), field.Name);
                Assert.That(copy.IsSameAs(changed), Is.True, field.Name);
            }
        }

        [Test]
        public void TrajectorySourcesAreCopiedAndComparedByAllFields()
        {
            foreach (FieldInfo field in FieldsOf(typeof(TrajectorySource)))
            {
                var changed = new TrajectorySource();
                field.SetValue(changed, OtherThan(field.GetValue(changed), field.FieldType));
                Assert.That(changed.IsSameAs(new TrajectorySource()), Is.False, field.Name);
                var copy = new TrajectorySource();
                copy.CopyFrom(changed);
                Assert.That(field.GetValue(copy), Is.EqualTo(field.GetValue(changed)), field.Name);
                Assert.That(copy.IsSameAs(changed), Is.True, field.Name);
            }
        }

        // Those of the class it is derived from are private there, and told by that alone.
        private static FieldInfo[] FieldsOf(Type type) => type
            .GetFields(BindingFlags.Instance | BindingFlags.NonPublic)
            .Concat(type.BaseType.GetFields(BindingFlags.Instance | BindingFlags.NonPublic))
            .Where(field => field.IsDefined(typeof(SerializeField))).ToArray();

        private static object OtherThan(object value, Type type)
        {
            if (type == typeof(TextAsset))
                return new TextAsset("other");
            if (type == typeof(MoleculeAsset))
                return MoleculeAsset.Create("other.pdb", new byte[1]);
            if (type == typeof(string))
                return value + "other";
            if (type == typeof(bool))
                return !(bool)value;
            if (type == typeof(int))
                return (int)value + 1;
            Assert.That(type.IsEnum, Is.True, $"a value of {type}");
            return Enum.GetValues(type).Cast<object>().First(other => !other.Equals(value));
        }
    }
}

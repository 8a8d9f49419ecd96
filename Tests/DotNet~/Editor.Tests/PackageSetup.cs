// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System.IO;

/// <summary>Has the project of each test the package's own assets.</summary>
[SetUpFixture]
public sealed class PackageSetup
{
    [OneTimeSetUp]
    public void AddPackage() => EditorDriver.PackageFolder = Path.Combine(Repository.Root, "UnityPackage");
}

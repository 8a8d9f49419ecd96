// SPDX-License-Identifier: MIT
// The default look of a molecular surface: opaque, physically based, coloured by vertex.
// First SubShader: Universal Render Pipeline 12 (Unity 2021.3) and later. Second: built-in pipeline.
// The High Definition Render Pipeline is not covered; a Shader Graph that reads Vertex Color does the same there.
Shader "QuickSES/Molecular Surface"
{
    Properties
    {
        [MainColor] _Color("Tint", Color) = (1, 1, 1, 1)
        _Smoothness("Smoothness", Range(0, 1)) = 0.45
        _Metallic("Metallic", Range(0, 1)) = 0
        // A mesh without the attribute reads 0, which would be black: hence off unless somebody turns it up.
        _OcclusionStrength("Ambient Occlusion (mesh TexCoord1.x, 1 = open)", Range(0, 1)) = 0
        [Enum(UnityEngine.Rendering.CullMode)] _Cull("Cull (Off = two-sided)", Float) = 2
        // The tint under the name that scripts written for the Universal Render Pipeline use; both are multiplied.
        [HideInInspector] _BaseColor("Tint", Color) = (1, 1, 1, 1)
    }

    SubShader
    {
        PackageRequirements
        {
            "com.unity.render-pipelines.universal"
        }

        Tags
        {
            "RenderPipeline" = "UniversalPipeline"
            "RenderType" = "Opaque"
            "Queue" = "Geometry"
            "UniversalMaterialType" = "Lit"
        }

        Cull [_Cull]

        HLSLINCLUDE
        #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Core.hlsl"

        // The same block in every pass, or the SRP Batcher refuses the shader.
        CBUFFER_START(UnityPerMaterial)
            half4 _Color;
            half4 _BaseColor;
            half _Smoothness;
            half _Metallic;
            half _OcclusionStrength;
        CBUFFER_END

        // An outward normal seen from inside, through a two-sided surface, must be turned round.
        half3 FacingNormal(half3 normalWS, FRONT_FACE_TYPE face)
        {
            return normalize(normalWS) * half(IS_FRONT_VFACE(face, 1.0, -1.0));
        }
        ENDHLSL

        Pass
        {
            // "ForwardOnly" is drawn by the Forward, Forward+ and Deferred renderers alike.
            Name "ForwardLit"
            Tags { "LightMode" = "UniversalForwardOnly" }

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile _ _MAIN_LIGHT_SHADOWS _MAIN_LIGHT_SHADOWS_CASCADE _MAIN_LIGHT_SHADOWS_SCREEN
            #pragma multi_compile _ _ADDITIONAL_LIGHTS_VERTEX _ADDITIONAL_LIGHTS
            // Clustered lights: URP 14 to 17.0 say _FORWARD_PLUS, later ones _CLUSTER_LIGHT_LOOP.
            #pragma multi_compile _ _FORWARD_PLUS _CLUSTER_LIGHT_LOOP
            #pragma multi_compile_fragment _ _ADDITIONAL_LIGHT_SHADOWS
            #pragma multi_compile_fragment _ _SHADOWS_SOFT
            #pragma multi_compile_fragment _ _SCREEN_SPACE_OCCLUSION
            #pragma multi_compile_fog
            #pragma multi_compile_instancing

            #include "Packages/com.unity.render-pipelines.core/ShaderLibrary/Color.hlsl"
            #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Lighting.hlsl"

            struct Attributes
            {
                float4 positionOS : POSITION;
                float3 normalOS : NORMAL;
                half4 color : COLOR;
                float2 occlusion : TEXCOORD1;
                UNITY_VERTEX_INPUT_INSTANCE_ID
            };

            struct Varyings
            {
                float4 positionCS : SV_POSITION;
                float3 positionWS : TEXCOORD0;
                half3 normalWS : TEXCOORD1;
                half4 colorAndOcclusion : TEXCOORD2;
                half4 fogAndVertexLight : TEXCOORD3;
                #if defined(REQUIRES_VERTEX_SHADOW_COORD_INTERPOLATOR)
                float4 shadowCoord : TEXCOORD4;
                #endif
                UNITY_VERTEX_INPUT_INSTANCE_ID
                UNITY_VERTEX_OUTPUT_STEREO
            };

            Varyings Vertex(Attributes input)
            {
                Varyings output = (Varyings)0;
                UNITY_SETUP_INSTANCE_ID(input);
                UNITY_TRANSFER_INSTANCE_ID(input, output);
                UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output);

                VertexPositionInputs position = GetVertexPositionInputs(input.positionOS.xyz);
                output.positionCS = position.positionCS;
                output.positionWS = position.positionWS;
                output.normalWS = half3(TransformObjectToWorldNormal(input.normalOS));

                // Colours of meshes are sRGB bytes, and nobody converts them on the way here.
                half3 color = input.color.rgb;
                #if !defined(UNITY_COLORSPACE_GAMMA)
                color = half3(SRGBToLinear(color));
                #endif
                half occlusion = lerp(half(1.0), saturate(half(input.occlusion.x)), _OcclusionStrength);
                output.colorAndOcclusion = half4(color, occlusion);

                half fog = half(ComputeFogFactor(position.positionCS.z));
                output.fogAndVertexLight = half4(fog, VertexLighting(position.positionWS, output.normalWS));
                #if defined(REQUIRES_VERTEX_SHADOW_COORD_INTERPOLATOR)
                output.shadowCoord = GetShadowCoord(position);
                #endif
                return output;
            }

            half4 Fragment(Varyings input, FRONT_FACE_TYPE face : FRONT_FACE_SEMANTIC) : SV_Target
            {
                UNITY_SETUP_INSTANCE_ID(input);
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);

                SurfaceData surface = (SurfaceData)0;
                surface.albedo = input.colorAndOcclusion.rgb * _Color.rgb * _BaseColor.rgb;
                surface.metallic = _Metallic;
                surface.smoothness = _Smoothness;
                surface.normalTS = half3(0, 0, 1);
                surface.occlusion = input.colorAndOcclusion.a;
                surface.alpha = 1;

                InputData lighting = (InputData)0;
                lighting.positionWS = input.positionWS;
                lighting.normalWS = FacingNormal(input.normalWS, face);
                lighting.viewDirectionWS = half3(GetWorldSpaceNormalizeViewDir(input.positionWS));
                #if defined(REQUIRES_VERTEX_SHADOW_COORD_INTERPOLATOR)
                lighting.shadowCoord = input.shadowCoord;
                #else
                lighting.shadowCoord = TransformWorldToShadowCoord(input.positionWS);
                #endif
                lighting.vertexLighting = input.fogAndVertexLight.yzw;
                lighting.bakedGI = SampleSH(lighting.normalWS);
                lighting.normalizedScreenSpaceUV = GetNormalizedScreenSpaceUV(input.positionCS);
                lighting.shadowMask = half4(1, 1, 1, 1);

                half4 color = UniversalFragmentPBR(lighting, surface);
                color.rgb = MixFog(color.rgb, input.fogAndVertexLight.x);
                return half4(color.rgb, 1);
            }
            ENDHLSL
        }

        Pass
        {
            Name "ShadowCaster"
            Tags { "LightMode" = "ShadowCaster" }

            ZWrite On
            ZTest LEqual
            ColorMask 0

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile_vertex _ _CASTING_PUNCTUAL_LIGHT_SHADOW
            #pragma multi_compile_instancing

            // Shadows.hlsl needs this one and, in URP 12 to 14, doesn't include it.
            #include "Packages/com.unity.render-pipelines.core/ShaderLibrary/CommonMaterial.hlsl"
            #include "Packages/com.unity.render-pipelines.universal/ShaderLibrary/Shadows.hlsl"

            // Set by the pipeline for each light that casts shadows.
            float3 _LightDirection;
            float3 _LightPosition;

            struct Attributes
            {
                float4 positionOS : POSITION;
                float3 normalOS : NORMAL;
                UNITY_VERTEX_INPUT_INSTANCE_ID
            };

            float4 Vertex(Attributes input) : SV_POSITION
            {
                UNITY_SETUP_INSTANCE_ID(input);
                float3 positionWS = TransformObjectToWorld(input.positionOS.xyz);
                float3 normalWS = TransformObjectToWorldNormal(input.normalOS);
                #if defined(_CASTING_PUNCTUAL_LIGHT_SHADOW)
                float3 lightDirection = normalize(_LightPosition - positionWS);
                #else
                float3 lightDirection = _LightDirection;
                #endif
                float4 positionCS = TransformWorldToHClip(ApplyShadowBias(positionWS, normalWS, lightDirection));
                // Casters behind the light's near plane are pulled onto it.
                #if UNITY_REVERSED_Z
                positionCS.z = min(positionCS.z, UNITY_NEAR_CLIP_VALUE);
                #else
                positionCS.z = max(positionCS.z, UNITY_NEAR_CLIP_VALUE);
                #endif
                return positionCS;
            }

            half4 Fragment() : SV_Target
            {
                return 0;
            }
            ENDHLSL
        }

        Pass
        {
            Name "DepthOnly"
            Tags { "LightMode" = "DepthOnly" }

            ZWrite On
            ColorMask R

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile_instancing

            struct Attributes
            {
                float4 positionOS : POSITION;
                UNITY_VERTEX_INPUT_INSTANCE_ID
            };

            struct Varyings
            {
                float4 positionCS : SV_POSITION;
                UNITY_VERTEX_OUTPUT_STEREO
            };

            Varyings Vertex(Attributes input)
            {
                Varyings output = (Varyings)0;
                UNITY_SETUP_INSTANCE_ID(input);
                UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output);
                output.positionCS = TransformObjectToHClip(input.positionOS.xyz);
                return output;
            }

            half4 Fragment(Varyings input) : SV_Target
            {
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
                return input.positionCS.z;
            }
            ENDHLSL
        }

        Pass
        {
            // Screen-space ambient occlusion reads these normals. "Only": in the Deferred renderer as well.
            Name "DepthNormals"
            Tags { "LightMode" = "DepthNormalsOnly" }

            ZWrite On

            HLSLPROGRAM
            #pragma target 3.5
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile_fragment _ _GBUFFER_NORMALS_OCT
            #pragma multi_compile_instancing

            #include "Packages/com.unity.render-pipelines.core/ShaderLibrary/Packing.hlsl"

            struct Attributes
            {
                float4 positionOS : POSITION;
                float3 normalOS : NORMAL;
                UNITY_VERTEX_INPUT_INSTANCE_ID
            };

            struct Varyings
            {
                float4 positionCS : SV_POSITION;
                half3 normalWS : TEXCOORD0;
                UNITY_VERTEX_OUTPUT_STEREO
            };

            Varyings Vertex(Attributes input)
            {
                Varyings output = (Varyings)0;
                UNITY_SETUP_INSTANCE_ID(input);
                UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(output);
                output.positionCS = TransformObjectToHClip(input.positionOS.xyz);
                output.normalWS = half3(TransformObjectToWorldNormal(input.normalOS));
                return output;
            }

            half4 Fragment(Varyings input, FRONT_FACE_TYPE face : FRONT_FACE_SEMANTIC) : SV_Target
            {
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(input);
                half3 normalWS = FacingNormal(input.normalWS, face);
                #if defined(_GBUFFER_NORMALS_OCT)
                float2 octahedral = saturate(PackNormalOctQuadEncode(normalWS) * 0.5 + 0.5);
                return half4(PackFloat2To888(octahedral), 0);
                #else
                return half4(normalWS, 0);
                #endif
            }
            ENDHLSL
        }
    }

    SubShader
    {
        Tags
        {
            "RenderType" = "Opaque"
            "Queue" = "Geometry"
        }

        Cull [_Cull]

        CGINCLUDE
        #include "UnityCG.cginc"
        #include "UnityPBSLighting.cginc"
        #include "AutoLight.cginc"

        half4 _Color;
        half4 _BaseColor;
        half _Smoothness;
        half _Metallic;
        half _OcclusionStrength;

        struct Attributes
        {
            float4 vertex : POSITION;
            float3 normal : NORMAL;
            fixed4 color : COLOR;
            float2 occlusion : TEXCOORD1;
            UNITY_VERTEX_INPUT_INSTANCE_ID
        };

        struct Varyings
        {
            UNITY_POSITION(pos);
            float3 worldPos : TEXCOORD0;
            half3 worldNormal : TEXCOORD1;
            half4 colorAndOcclusion : TEXCOORD2;
            half3 ambient : TEXCOORD3;
            UNITY_FOG_COORDS(4)
            UNITY_LIGHTING_COORDS(5, 6)
            UNITY_VERTEX_INPUT_INSTANCE_ID
            UNITY_VERTEX_OUTPUT_STEREO
        };

        struct Material
        {
            half3 diffuse;
            half3 specular;
            half oneMinusReflectivity;
            half3 normal;
            half3 viewDirection;
        };

        Varyings ForwardVertex(Attributes v)
        {
            UNITY_SETUP_INSTANCE_ID(v);
            Varyings o;
            UNITY_INITIALIZE_OUTPUT(Varyings, o);
            UNITY_TRANSFER_INSTANCE_ID(v, o);
            UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(o);

            o.pos = UnityObjectToClipPos(v.vertex);
            o.worldPos = mul(unity_ObjectToWorld, v.vertex).xyz;
            o.worldNormal = UnityObjectToWorldNormal(v.normal);

            // Colours of meshes are sRGB bytes, and nobody converts them on the way here.
            half3 color = v.color.rgb;
            #if !defined(UNITY_COLORSPACE_GAMMA)
            color = GammaToLinearSpace(color);
            #endif
            o.colorAndOcclusion = half4(color, lerp(1, saturate(v.occlusion.x), _OcclusionStrength));

            UNITY_TRANSFER_LIGHTING(o, float2(0, 0));
            UNITY_TRANSFER_FOG(o, o.pos);
            return o;
        }

        Material MaterialAt(Varyings i, fixed facing)
        {
            Material material;
            half3 albedo = i.colorAndOcclusion.rgb * _Color.rgb * _BaseColor.rgb;
            material.diffuse = DiffuseAndSpecularFromMetallic(
                albedo, _Metallic, material.specular, material.oneMinusReflectivity);
            // An outward normal seen from inside, through a two-sided surface, must be turned round.
            material.normal = normalize(i.worldNormal) * (facing > 0 ? 1 : -1);
            material.viewDirection = normalize(UnityWorldSpaceViewDir(i.worldPos));
            return material;
        }

        half3 Shade(Material material, UnityLight light, UnityIndirect indirect)
        {
            return UNITY_BRDF_PBS(material.diffuse, material.specular, material.oneMinusReflectivity, _Smoothness,
                material.normal, material.viewDirection, light, indirect).rgb;
        }
        ENDCG

        Pass
        {
            Name "ForwardBase"
            Tags { "LightMode" = "ForwardBase" }

            CGPROGRAM
            #pragma target 3.0
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile_fwdbase nolightmap nodynlightmap nodirlightmap
            #pragma multi_compile_fog
            #pragma multi_compile_instancing

            // With the light of probes and of lights that are not lit by pixel.
            Varyings Vertex(Attributes v)
            {
                Varyings o = ForwardVertex(v);
                #if defined(VERTEXLIGHT_ON)
                o.ambient = Shade4PointLights(unity_4LightPosX0, unity_4LightPosY0, unity_4LightPosZ0,
                    unity_LightColor[0].rgb, unity_LightColor[1].rgb, unity_LightColor[2].rgb, unity_LightColor[3].rgb,
                    unity_4LightAtten0, o.worldPos, o.worldNormal);
                #endif
                o.ambient = ShadeSHPerVertex(o.worldNormal, o.ambient);
                return o;
            }

            half4 Fragment(Varyings i, fixed facing : VFACE) : SV_Target
            {
                UNITY_SETUP_INSTANCE_ID(i);
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(i);
                Material material = MaterialAt(i, facing);
                UNITY_LIGHT_ATTENUATION(attenuation, i, i.worldPos);

                UnityGIInput input;
                UNITY_INITIALIZE_OUTPUT(UnityGIInput, input);
                input.light.color = _LightColor0.rgb;
                input.light.dir = _WorldSpaceLightPos0.xyz;
                input.worldPos = i.worldPos;
                input.worldViewDir = material.viewDirection;
                input.atten = attenuation;
                input.ambient = i.ambient;
                input.probeHDR[0] = unity_SpecCube0_HDR;
                input.probeHDR[1] = unity_SpecCube1_HDR;
                #if defined(UNITY_SPECCUBE_BLENDING) || defined(UNITY_SPECCUBE_BOX_PROJECTION)
                input.boxMin[0] = unity_SpecCube0_BoxMin;
                #endif
                #if defined(UNITY_SPECCUBE_BOX_PROJECTION)
                input.boxMax[0] = unity_SpecCube0_BoxMax;
                input.probePosition[0] = unity_SpecCube0_ProbePosition;
                input.boxMax[1] = unity_SpecCube1_BoxMax;
                input.boxMin[1] = unity_SpecCube1_BoxMin;
                input.probePosition[1] = unity_SpecCube1_ProbePosition;
                #endif
                Unity_GlossyEnvironmentData reflection = UnityGlossyEnvironmentSetup(
                    _Smoothness, material.viewDirection, material.normal, material.specular);
                UnityGI gi = UnityGlobalIllumination(
                    input, i.colorAndOcclusion.a, material.normal, reflection);

                half4 color = half4(Shade(material, gi.light, gi.indirect), 1);
                UNITY_APPLY_FOG(i.fogCoord, color);
                return color;
            }
            ENDCG
        }

        Pass
        {
            // One pass for each further light that is lit by pixel.
            Name "ForwardAdd"
            Tags { "LightMode" = "ForwardAdd" }

            Blend One One
            ZWrite Off

            CGPROGRAM
            #pragma target 3.0
            #pragma vertex ForwardVertex
            #pragma fragment Fragment
            #pragma multi_compile_fwdadd_fullshadows
            #pragma multi_compile_fog
            #pragma multi_compile_instancing

            half4 Fragment(Varyings i, fixed facing : VFACE) : SV_Target
            {
                UNITY_SETUP_INSTANCE_ID(i);
                UNITY_SETUP_STEREO_EYE_INDEX_POST_VERTEX(i);
                UNITY_LIGHT_ATTENUATION(attenuation, i, i.worldPos);

                UnityLight light;
                UNITY_INITIALIZE_OUTPUT(UnityLight, light);
                light.color = _LightColor0.rgb * attenuation;
                light.dir = normalize(UnityWorldSpaceLightDir(i.worldPos));
                UnityIndirect none;
                UNITY_INITIALIZE_OUTPUT(UnityIndirect, none);

                half4 color = half4(Shade(MaterialAt(i, facing), light, none), 0);
                UNITY_APPLY_FOG_COLOR(i.fogCoord, color, half4(0, 0, 0, 0));
                return color;
            }
            ENDCG
        }

        Pass
        {
            Name "ShadowCaster"
            Tags { "LightMode" = "ShadowCaster" }

            ZWrite On
            ZTest LEqual

            CGPROGRAM
            #pragma target 3.0
            #pragma vertex Vertex
            #pragma fragment Fragment
            #pragma multi_compile_shadowcaster
            #pragma multi_compile_instancing

            struct ShadowVaryings
            {
                V2F_SHADOW_CASTER;
                UNITY_VERTEX_OUTPUT_STEREO
            };

            ShadowVaryings Vertex(Attributes v)
            {
                ShadowVaryings o;
                UNITY_SETUP_INSTANCE_ID(v);
                UNITY_INITIALIZE_OUTPUT(ShadowVaryings, o);
                UNITY_INITIALIZE_VERTEX_OUTPUT_STEREO(o);
                TRANSFER_SHADOW_CASTER_NORMALOFFSET(o)
                return o;
            }

            half4 Fragment(ShadowVaryings i) : SV_Target
            {
                SHADOW_CASTER_FRAGMENT(i)
            }
            ENDCG
        }
    }
}

// Unreal Engine 5: the row of library.csv as a struct of a DataTable. Name is the row's name. NOT built in an engine;
// tests/cli compares its members with the columns.
#pragma once

#include "CoreMinimal.h"
#include "Engine/DataTable.h"

#include "UkemiReaction.generated.h"

USTRUCT(BlueprintType)
struct FUkemiReaction : public FTableRowBase
{
    GENERATED_BODY()

    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString Character;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString Reaction;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString Clip;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString File;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString Segment;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float FromDeg = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float FromElevationDeg = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString From;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString Preset;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float MomentumNs = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString Behaviour;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString Outcome;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString EndPose;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float TurnDeg = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float TravelX = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float TravelY = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float TravelZ = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) int32 Steps = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float FirstStepS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float LastStepS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float FallBeginsS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float DurationS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float ImpactS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float FirstGroundContactS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float RestS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float GetUpS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float RecoveredS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float Fps = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float HeadContactS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float ChestContactS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float PelvisContactS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float HandContactS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float ForearmContactS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float KneeContactS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString StartPose;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString StartClip;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float StartClipS = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString RootMotion;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) bool Additive = false;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) bool Loopable = false;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) float PeakHeadSpeed = 0;
    UPROPERTY(EditAnywhere, BlueprintReadOnly) FString Verdict;
};

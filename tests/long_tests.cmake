# SPDX-License-Identifier: BSD-3-Clause
# Read by ctest once the tests of grouser_tests are known. It starts the longest ones first (COST: about what they take
# [s], until it has measured them itself), so that none is left alone at the end, and gives two cores to those of
# several ranks or threads: where other tests take their cores they wait for each other many times as long.
foreach(test
    "GranularBed.ShoesSinkWhileTheyCarryAndArePickedUp 60"
    "OneAnswer.OfATowingVehicle 20"
    "SoilCommandTest.PartsMayBeginTogether 40"
    "SoilCommandTest.MeasuresInSlicesAndWritesItsTables 40"
    "LedgerOfAVehicle.OnItsBedBalancesInMomenta 35"
    "GranularBed.CarriesTheWholeWeightAtRest 35"
    "BedPreparation.PorosityWantedIsReachedWithTheSameFrictionForEverySeed 30"
    "OneAnswer.OnObstacles 25"
    "MechanismRun.NoShippedMechanismIsWarnedOf 25"
    "Documents.ScenesCanBePlanned 23"
    "BedPreparation.GrainsStickOnlyOnceTheyLie 22"
    "FullDisk.LimitToTheSizeOfAnyFileLosesNothing 20"
    "BenchCommands.StepSaysWhetherTheVehicleDrivesAndWaitsForIt 20"
    "RigidGround.ShoesStayLevelAndSpeedIsPitchRadiusTimesOmega 15"
    "OneAnswer.CoupledSceneOnOneThread 15"
    "OneAnswer.CoupledSceneOnTwoThreadsWithOtherRebuilds 15"
    "OneAnswer.AnotherSeedIsAnotherState 15"
    "OnRanks.PeriodicBoundariesMovingSurfacesSourcesAndRigsGiveTheBitsOfOneRank 15"
    "OnRanks.VehicleDrivesAcrossBordersWithTheBitsOfOneRank 15"
    "Towing.ASledPullsWithItsFriction 15"
    "AtRest.TheGradeThatItHoldsIsItsFriction 15")
  string(REPLACE " " ";" test "${test}")
  list(GET test 0 name)
  list(GET test 1 seconds)
  set_tests_properties(${name} PROPERTIES COST ${seconds})
  if(name MATCHES "^OnRanks|^OneAnswer.On|^OneAnswer.OfA")
    set_tests_properties(${name} PROPERTIES PROCESSORS 2)
  endif()
endforeach()
